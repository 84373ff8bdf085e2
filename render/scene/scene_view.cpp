// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/scene_view.hpp"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "render/scene/offscreen_context.hpp"
#include "sim/environment/mujoco_model.hpp"

namespace aims {
namespace {

constexpr int kMaxGeoms = 20000;
constexpr double kFieldOfViewDeg = 50.0;  ///< from the lower edge to the upper

void set_quality(mjModel& model, const ViewConfig& config) {
  model.vis.global.offwidth = config.width;
  model.vis.global.offheight = config.height;
  model.vis.global.fovy = static_cast<float>(kFieldOfViewDeg);
  model.vis.quality.offsamples = config.samples;
  model.vis.quality.shadowsize = 4096;
  // Near and far plane and shadow box are in units of the model's extent: keep them in metres,
  // whatever the length of the corridor.
  model.stat.extent = 1.0;
  model.vis.map.znear = 0.05F;
  model.vis.map.zfar = 150.0F;
  model.vis.map.shadowclip = 2.0F;
  for (float* color : {model.vis.headlight.ambient, model.vis.headlight.diffuse}) {
    std::fill(color, color + 3, 0.42F);
  }
  std::fill(model.vis.headlight.specular, model.vis.headlight.specular + 3, 0.15F);
}

void set_sky(mjModel& model, const Color& color) {
  const std::array<double, 3> rgb = {color.red, color.green, color.blue};
  for (int i = 0; i < model.ntex; ++i) {
    if (model.tex_type[i] != mjTEXTURE_SKYBOX) continue;
    const int values = 3 * model.tex_width[i] * model.tex_height[i];
    for (int k = 0; k < values; ++k) {
      const double value = 255.0 * rgb[static_cast<std::size_t>(k % 3)];
      model.tex_rgb[model.tex_adr[i] + k] = static_cast<mjtByte>(std::lround(value));
    }
  }
}

/// Pixels per metre at a distance of one metre.
float focal_length(const ViewConfig& config) {
  const double half = 0.5 * kFieldOfViewDeg * std::numbers::pi / 180.0;
  return static_cast<float>(0.5 * config.height / std::tan(half));
}

/// Replaces the scene's lamps by one high above, leaning towards the camera: the robot is lit from
/// where it is looked at, its shadow lies under it, and a corridor's walls hardly throw any.
void set_lamp(mjvScene& scene, const Camera& camera) {
  scene.nlight = std::min(scene.nlight, 1);  // keeps the headlight, which comes first
  mjvLight& light = scene.lights[scene.nlight++];
  std::memset(&light, 0, sizeof(light));
  const Eigen::Vector3d back = camera.position() - camera.target;
  const Eigen::Vector2d aside = back.head<2>().normalized();
  const Eigen::Vector3f offset(static_cast<float>(0.4 * aside.x()),
                               static_cast<float>(0.4 * aside.y()), 2.6F);
  for (int i = 0; i < 3; ++i) {
    light.pos[i] = static_cast<float>(camera.target[i]) + offset[i];
    light.dir[i] = -offset.normalized()[i];
    light.ambient[i] = 0.08F;
    light.diffuse[i] = 0.56F;
    light.specular[i] = 0.30F;
  }
  light.attenuation[0] = 1.0F;
  light.directional = 1;
  light.castshadow = 1;
}

Image read_picture(const mjrRect& viewport, const mjrContext& context) {
  Image picture(viewport.width, viewport.height);
  std::vector<std::uint8_t> rows(picture.rgb.size());
  mjr_readPixels(rows.data(), nullptr, viewport, &context);
  const auto stride = static_cast<std::ptrdiff_t>(viewport.width) * 3;
  for (int row = 0; row < viewport.height; ++row) {  // OpenGL starts at the bottom
    std::copy_n(rows.begin() + row * stride, stride,
                picture.rgb.begin() + (viewport.height - 1 - row) * stride);
  }
  return picture;
}

}  // namespace

Eigen::Vector3d Camera::position() const {
  const double azimuth = azimuth_deg * std::numbers::pi / 180.0;
  const double elevation = elevation_deg * std::numbers::pi / 180.0;
  const Eigen::Vector3d forward(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  return target - distance * forward;
}

struct SceneView::Impl {
  ViewConfig config;
  MujocoModel model;
  MujocoData data;
  std::optional<OffscreenContext> gl;  // outlives what MuJoCo keeps in it
  mjvScene scene{};
  mjvOption option{};
  mjrContext context{};

  Impl() {
    mjv_defaultScene(&scene);
    mjv_defaultOption(&option);
    mjr_defaultContext(&context);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    mjr_freeContext(&context);
    mjv_freeScene(&scene);
  }
};

SceneView::SceneView(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SceneView::SceneView(SceneView&&) noexcept = default;
SceneView& SceneView::operator=(SceneView&&) noexcept = default;
SceneView::~SceneView() = default;

Result<SceneView> SceneView::create(const std::string& mjcf, const std::vector<float>& height_field,
                                    const ViewConfig& config) {
  auto impl = std::make_unique<Impl>();
  impl->config = config;
  auto model = load_mujoco_model(mjcf, height_field);
  if (!model) return tl::unexpected(model.error());
  impl->model = std::move(*model);
  set_quality(*impl->model, config);
  if (config.sky) set_sky(*impl->model, *config.sky);
  impl->data.reset(mj_makeData(impl->model.get()));
  auto gl = OffscreenContext::create();
  if (!gl) return tl::unexpected(gl.error());
  impl->gl.emplace(std::move(*gl));
  mjv_makeScene(impl->model.get(), &impl->scene, kMaxGeoms);
  mjr_makeContext(impl->model.get(), &impl->context, mjFONTSCALE_100);
  mjr_setBuffer(mjFB_OFFSCREEN, &impl->context);
  if (impl->context.currentBuffer != mjFB_OFFSCREEN) {
    return failure("OpenGL offers no off-screen buffer to draw to");
  }
  impl->scene.flags[mjRND_SHADOW] = config.shadows ? 1 : 0;
  return SceneView(std::move(impl));
}

Result<Image> SceneView::draw(const std::vector<double>& qpos, const Camera& camera,
                              const ViewOverlay& overlay) {
  mjModel* model = impl_->model.get();
  if (qpos.size() != static_cast<std::size_t>(model->nq)) {
    return failure(fmt::format("the model to draw has {} joint positions, the snapshot {}",
                               model->nq, qpos.size()));
  }
  if (!std::all_of(qpos.begin(), qpos.end(), [](double q) { return std::isfinite(q); })) {
    return failure("the snapshot to draw has a joint position that is not finite");
  }
  std::copy(qpos.begin(), qpos.end(), impl_->data->qpos);
  mj_kinematics(model, impl_->data.get());
  mj_comPos(model, impl_->data.get());
  mj_camlight(model, impl_->data.get());
  mjvCamera eye;
  mjv_defaultCamera(&eye);
  std::copy_n(camera.target.data(), 3, eye.lookat);
  eye.distance = camera.distance;
  eye.azimuth = camera.azimuth_deg;
  eye.elevation = camera.elevation_deg;
  mjv_updateScene(model, impl_->data.get(), &impl_->option, nullptr, &eye, mjCAT_ALL,
                  &impl_->scene);
  set_lamp(impl_->scene, camera);
  const mjrRect viewport{0, 0, impl_->config.width, impl_->config.height};
  mjr_render(viewport, &impl_->scene, &impl_->context);
  draw_overlay(overlay, focal_length(impl_->config));
  return read_picture(viewport, impl_->context);
}

}  // namespace aims
