// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/surface_relief.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// At smaller angles between ray and surface the relief would shade itself; hits then move as at
/// this cosine of the incidence.
constexpr float kLeastCosine = 0.03F;
/// Beyond it no relief is looked up [m].
constexpr float kFarthest = 5000.0F;
/// Of a face's normal against the vertical; below it the face is a wall [-].
constexpr float kUpright = 0.5F;

using Lanes = SurfaceTable::Lanes;

bool on_one_face(const HitPacket& hits, int a, int b) {
  return hits.surface[a] == hits.surface[b] && hits.normal_x[a] == hits.normal_x[b] &&
         hits.normal_y[a] == hits.normal_y[b] && hits.normal_z[a] == hits.normal_z[b];
}

/// Step along the ray to a relief whose height at its present point is `above` the point's: the
/// distance changes by cosine and slope.
float step_to(float above, float cosine, float slope_along_ray) {
  return -above / std::max(cosine + slope_along_ray, kLeastCosine);
}

/// Adds the crowns of the joints, (1 - q^2)^2 over their width with q = -1 to 1.
void add_joints(const PanelConfig& panels, float offset, const Lanes& u,
                SurfaceTable::Samples& samples) {
  const auto crown = static_cast<float>(panels.crown);
  const auto spacing = static_cast<float>(panels.spacing);
  const auto per_width = static_cast<float>(2.0 / panels.width);
  for (int i = 0; i < kRayPacketSize; ++i) {
    const float panel = (u[i] + offset) / spacing;
    const auto nearest = static_cast<std::int32_t>(panel + (panel < 0.0F ? -0.5F : 0.5F));
    const float q = (panel - static_cast<float>(nearest)) * spacing * per_width;
    const float rest = std::max(1.0F - q * q, 0.0F);
    samples.height[i] += crown * rest * rest;
    samples.slope_u[i] -= 4.0F * crown * per_width * q * rest;
  }
}

/// Hits and rays in the axes of a face.
struct alignas(64) OnFace {
  Lanes u, v;              ///< of the hits [m]
  Lanes along_u, along_v;  ///< of the rays' directions [-]
  Lanes cosine;            ///< of the incidence on the plane [-]
};

void project(const Eigen::Vector3f& u, const Eigen::Vector3f& v, const Eigen::Vector3f& normal,
             const RayPacket& rays, const HitPacket& hits, OnFace& on) {
  for (int i = 0; i < kRayPacketSize; ++i) {
    const float x = rays.direction_x[i], y = rays.direction_y[i], z = rays.direction_z[i];
    const float from_x = rays.origin_x[i], from_y = rays.origin_y[i], from_z = rays.origin_z[i];
    const float distance = std::min(hits.distance[i], kFarthest);
    on.along_u[i] = u.x() * x + u.y() * y + u.z() * z;
    on.along_v[i] = v.x() * x + v.y() * y + v.z() * z;
    on.cosine[i] = -(normal.x() * x + normal.y() * y + normal.z() * z);
    on.u[i] = u.x() * from_x + u.y() * from_y + u.z() * from_z + distance * on.along_u[i];
    on.v[i] = v.x() * from_x + v.y() * from_y + v.z() * from_z + distance * on.along_v[i];
  }
}

/// Normals of the relief; that of the plane where the relief's faces away from the ray.
void tilt(const Eigen::Vector3f& u, const Eigen::Vector3f& v, const Eigen::Vector3f& normal,
          const OnFace& on, const SurfaceTable::Samples& at, HitPacket& hits) {
  alignas(64) Lanes length;
  for (int i = 0; i < kRayPacketSize; ++i) {
    length[i] = 1.0F + at.slope_u[i] * at.slope_u[i] + at.slope_v[i] * at.slope_v[i];
  }
  // Of an array of Eigen, whose root is one instruction for several lanes.
  Eigen::Map<Eigen::Array<float, kRayPacketSize, 1>, Eigen::Aligned64> roots(length.data());
  roots = roots.sqrt();
  for (int i = 0; i < kRayPacketSize; ++i) {
    const float slope = at.slope_u[i] * on.along_u[i] + at.slope_v[i] * on.along_v[i];
    const bool faces_ray = on.cosine[i] + slope > kLeastCosine * length[i];
    const float tilt_u = faces_ray ? at.slope_u[i] : 0.0F;
    const float tilt_v = faces_ray ? at.slope_v[i] : 0.0F;
    const float scale = faces_ray ? 1.0F / length[i] : 1.0F;
    hits.normal_x[i] = scale * (normal.x() - tilt_u * u.x() - tilt_v * v.x());
    hits.normal_y[i] = scale * (normal.y() - tilt_u * u.y() - tilt_v * v.y());
    hits.normal_z[i] = scale * (normal.z() - tilt_u * u.z() - tilt_v * v.z());
  }
}

}  // namespace

SurfaceRelief::SurfaceRelief(const SurfaceConfig& config, const Scene& scene, std::uint64_t seed)
    : table_(config, seed), panels_(config.panels) {
  RandomStream offsets = rng(seed, "scene.relief.offsets");
  RandomStream joints = rng(seed, "scene.joints.offsets");
  for (const Solid& solid : scene.solids) {
    add(solid.T_world_solid.R(), solid.half_extents,
        solid.shape != Shape::kBox || solid.material.return_cosine > 0.0, offsets, joints);
  }
  const Eigen::Vector2d size = scene.floor.max_corner - scene.floor.min_corner;
  add(Eigen::Matrix3d::Identity(), {size.x(), size.y(), 0.0}, false, offsets, joints);
}

void SurfaceRelief::add(const Eigen::Matrix3d& R, const Eigen::Vector3d& half_extents, bool smooth,
                        RandomStream& offsets, RandomStream& joints) {
  Box box;
  box.smooth = smooth;
  box.axes = R.cast<float>();
  for (int normal = 0; normal < 3; ++normal) {
    int u = (normal + 1) % 3;
    int v = (normal + 2) % 3;
    if (half_extents[v] > half_extents[u]) std::swap(u, v);  // u is the longer side
    Face& face = box.faces[normal];
    face.u = box.axes.col(u);
    face.v = box.axes.col(v);
    face.offset_u =
        static_cast<float>(offsets.uniform(0.0, SurfaceTable::kColumns) * SurfaceTable::kCell);
    face.offset_v =
        static_cast<float>(offsets.uniform(0.0, SurfaceTable::kRows) * SurfaceTable::kCell);
    face.offset_of_joints = static_cast<float>(joints.uniform() * panels_.spacing);
    face.has_panels = panels_.spacing > 0.0 && std::abs(box.axes(2, normal)) < kUpright &&
                      std::abs(face.u.z()) < kUpright;
  }
  boxes_.push_back(box);
}

const SurfaceRelief::Face& SurfaceRelief::face_of(const Box& box,
                                                  const Eigen::Vector3f& normal) const {
  Eigen::Index face = 0;
  (box.axes.transpose() * normal).cwiseAbs().maxCoeff(&face);
  return box.faces[static_cast<std::size_t>(face)];
}

void SurfaceRelief::displace(const RayPacket& rays, HitPacket& hits) const {
  const HitPacket smooth = hits;
  hits.texture.fill(1.0F);
  for (int first = 0; first < kRayPacketSize;) {
    int last = first + 1;
    while (last < kRayPacketSize && on_one_face(smooth, first, last)) ++last;
    const int surface = smooth.surface[first];
    if (surface >= 0) {
      const Box& box = boxes_[static_cast<std::size_t>(surface)];
      if (!box.smooth) displace_on(face_of(box, normal_of(smooth, first)), rays, first, last, hits);
    }
    first = last;
  }
}

void SurfaceRelief::sample(const Face& face, const Lanes& u, const Lanes& v,
                           SurfaceTable::Samples& samples) const {
  table_.sample(u, v, samples);
  if (!face.has_panels) return;
  alignas(64) Lanes along;
  for (int i = 0; i < kRayPacketSize; ++i) along[i] = u[i] - face.offset_u;
  add_joints(panels_, face.offset_of_joints, along, samples);
}

/// All lanes are computed, those from `first` to before `last` are on the face and written.
void SurfaceRelief::displace_on(const Face& face, const RayPacket& rays, int first, int last,
                                HitPacket& hits) const {
  const Eigen::Vector3f normal = normal_of(hits, first);
  OnFace on;
  project(face.u, face.v, normal, rays, hits, on);
  for (int i = 0; i < kRayPacketSize; ++i) {
    on.u[i] += face.offset_u;
    on.v[i] += face.offset_v;
  }
  SurfaceTable::Samples at;
  sample(face, on.u, on.v, at);
  alignas(64) Lanes farther;
  for (int i = 0; i < kRayPacketSize; ++i) {
    const float slope = at.slope_u[i] * on.along_u[i] + at.slope_v[i] * on.along_v[i];
    farther[i] = step_to(at.height[i], on.cosine[i], slope);
    on.u[i] += farther[i] * on.along_u[i];
    on.v[i] += farther[i] * on.along_v[i];
  }
  sample(face, on.u, on.v, at);
  for (int i = 0; i < kRayPacketSize; ++i) {
    const float slope = at.slope_u[i] * on.along_u[i] + at.slope_v[i] * on.along_v[i];
    farther[i] += step_to(at.height[i] + farther[i] * on.cosine[i], on.cosine[i], slope);
  }
  HitPacket moved;
  tilt(face.u, face.v, normal, on, at, moved);
  for (int i = first; i < last; ++i) {
    hits.distance[i] += farther[i];
    hits.normal_x[i] = moved.normal_x[i];
    hits.normal_y[i] = moved.normal_y[i];
    hits.normal_z[i] = moved.normal_z[i];
    hits.texture[i] = at.factor[i];
  }
}

}  // namespace aims
