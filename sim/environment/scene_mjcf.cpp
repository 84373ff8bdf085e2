// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/scene_mjcf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>
#include <sstream>

namespace aims {
namespace {

std::string text(const Eigen::Vector3d& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

std::string text(const Eigen::Quaterniond& q) {
  return fmt::format("{} {} {} {}", q.w(), q.x(), q.y(), q.z());
}

std::string rgba(const Material& material) {
  const Eigen::Vector3f& color = material.color;
  const bool glass = material.return_cosine > 0.0;
  return fmt::format("{} {} {} {}", color.x(), color.y(), color.z(), glass ? 0.3 : 1.0);
}

void set(pugi::xml_node node, const char* name, const std::string& value) {
  if (!node.attribute(name)) node.append_attribute(name);
  node.attribute(name).set_value(value.c_str());
}

/// The child of that name, made when there is none.
pugi::xml_node child(pugi::xml_node parent, const char* name) {
  const pugi::xml_node found = parent.child(name);
  return found ? found : parent.append_child(name);
}

/// Adds one scene to one MJCF document.
class SceneWriter {
 public:
  SceneWriter(const Scene& scene, MjcfPurpose purpose, const MjcfOptions& options,
              pugi::xml_node root)
      : scene_(scene), render_(purpose == MjcfPurpose::kRender), options_(options), root_(root) {}

  void write() {
    if (render_) {
      add_appearance();
    } else {
      // Geoms without collisions would halve the speed of the physics.
      set(child(root_, "compiler"), "discardvisual", "true");
    }
    add_floor();
    for (std::size_t i = 0; i < scene_.solids.size(); ++i) {
      const Solid& solid = scene_.solids[i];
      const bool wanted =
          render_ ? solid.visible && (!solid.roof || options_.roof) : solid.collides;
      if (wanted) add_solid(solid, fmt::format("{}{}", kSolidGeomPrefix, i));
    }
  }

 private:
  /// A static geom with every attribute that the robot's defaults might change.
  pugi::xml_node add_geom(const std::string& name, const char* type) {
    pugi::xml_node geom = child(root_, "worldbody").append_child("geom");
    set(geom, "name", name);
    set(geom, "type", type);
    const char* collides = render_ ? "0" : "1";
    set(geom, "contype", collides);
    set(geom, "conaffinity", collides);
    set(geom, "condim", "3");
    set(geom, "priority", "0");
    set(geom, "margin", "0");
    set(geom, "group", "0");
    set(geom, "friction", fmt::format("{} 0.005 0.0001", options_.floor_friction));
    return geom;
  }

  void add_solid(const Solid& solid, const std::string& name) {
    const bool box = solid.shape == Shape::kBox;
    pugi::xml_node geom = add_geom(name, box ? "box" : "cylinder");
    set(geom, "pos", text(solid.T_world_solid.translation));
    set(geom, "quat", text(solid.T_world_solid.rotation));
    const Eigen::Vector3d& half = solid.half_extents;
    set(geom, "size", box ? text(half) : fmt::format("{} {}", half.x(), half.z()));
    if (!render_) return;
    set(geom, "material", "scene_matte");
    set(geom, "rgba", rgba(solid.material));
  }

  void add_floor() {
    const Floor& floor = scene_.floor;
    const Eigen::Vector2d half = 0.5 * (floor.max_corner - floor.min_corner);
    const Eigen::Vector2d centre = 0.5 * (floor.max_corner + floor.min_corner);
    const bool flat = floor.heights.empty();
    pugi::xml_node geom = add_geom(std::string(kFloorGeomName), flat ? "plane" : "hfield");
    set(geom, "pos", text(Eigen::Vector3d(centre.x(), centre.y(), 0.0)));
    if (render_) set(geom, "material", "scene_floor");
    if (flat) {
      // Physics gets a plane without end: nothing falls off the scene's border.
      set(geom, "size", render_ ? fmt::format("{} {} 1", half.x(), half.y()) : "0 0 1");
      return;
    }
    set(geom, "hfield", "scene_floor");
    pugi::xml_node field = child(root_, "asset").append_child("hfield");
    set(field, "name", "scene_floor");
    set(field, "nrow", std::to_string(floor.rows));
    set(field, "ncol", std::to_string(floor.columns));
    const float top = *std::max_element(floor.heights.begin(), floor.heights.end());
    set(field, "size", fmt::format("{} {} {} 0.1", half.x(), half.y(), std::max(top, 1e-6F)));
  }

  void add_appearance() {
    add_materials();
    add_lights();
    pugi::xml_node visual = child(root_, "visual");
    set(child(visual, "global"), "offwidth", std::to_string(options_.image_width));
    set(child(visual, "global"), "offheight", std::to_string(options_.image_height));
    // Near and far planes are given in units of the extent: 4 cm to 400 m.
    set(child(root_, "statistic"), "extent", "2");
    set(child(visual, "map"), "znear", "0.02");
    set(child(visual, "map"), "zfar", "200");
    set(child(visual, "map"), "shadowclip", "1.5");
    set(child(visual, "quality"), "shadowsize", "2048");
    pugi::xml_node headlight = child(visual, "headlight");
    set(headlight, "ambient", "0.38 0.38 0.38");
    set(headlight, "diffuse", "0.18 0.18 0.18");
    set(headlight, "specular", "0 0 0");
  }

  void add_materials() {
    pugi::xml_node assets = child(root_, "asset");
    pugi::xml_node sky = assets.append_child("texture");
    for (const auto& [name, value] : {std::pair{"type", "skybox"},
                                      {"builtin", "gradient"},
                                      {"rgb1", "0.93 0.95 0.97"},
                                      {"rgb2", "0.75 0.80 0.86"},
                                      {"width", "64"},
                                      {"height", "64"}}) {
      set(sky, name, value);
    }
    const Eigen::Vector3d color = scene_.floor.material.color.cast<double>();
    pugi::xml_node tiles = assets.append_child("texture");
    for (const auto& [name, value] : {std::pair{"name", "scene_floor"},
                                      {"type", "2d"},
                                      {"builtin", "checker"},
                                      {"mark", "edge"},
                                      {"markrgb", "0.40 0.41 0.43"},
                                      {"width", "256"},
                                      {"height", "256"}}) {
      set(tiles, name, value);
    }
    set(tiles, "rgb1", text(color));
    set(tiles, "rgb2", text(Eigen::Vector3d(0.9 * color)));
    pugi::xml_node floor = assets.append_child("material");
    for (const auto& [name, value] : {std::pair{"name", "scene_floor"},
                                      {"texture", "scene_floor"},
                                      {"texuniform", "true"},
                                      {"texrepeat", "1 1"},
                                      {"specular", "0.1"},
                                      {"shininess", "0.1"},
                                      {"reflectance", "0"}}) {
      set(floor, name, value);
    }
    pugi::xml_node matte = assets.append_child("material");
    for (const auto& [name, value] : {std::pair{"name", "scene_matte"},
                                      {"specular", "0.05"},
                                      {"shininess", "0.05"},
                                      {"reflectance", "0"}}) {
      set(matte, name, value);
    }
  }

  void add_lights() {
    pugi::xml_node world = child(root_, "worldbody");
    // Two lights without shadow brighten the walls, one from each side.
    for (const char* direction : {"0.4 0.8 -0.4", "-0.4 -0.8 -0.4"}) {
      pugi::xml_node fill = world.append_child("light");
      set(fill, "directional", "true");
      set(fill, "castshadow", "false");
      set(fill, "dir", direction);
      set(fill, "diffuse", "0.32 0.32 0.31");
      set(fill, "specular", "0 0 0");
    }
    // The key light follows the robot, for a sharp shadow everywhere. It is steep, so that walls
    // cast short shadows.
    pugi::xml_node robot = world.child("body");
    pugi::xml_node key = (robot ? robot : world).append_child("light");
    set(key, "mode", robot ? "trackcom" : "fixed");
    set(key, "directional", "true");
    set(key, "castshadow", "true");
    set(key, "pos", "0 0 2.5");
    set(key, "dir", "0.15 -0.12 -1");
    set(key, "diffuse", "0.4 0.4 0.4");
    set(key, "specular", "0.1 0.1 0.1");
  }

  const Scene& scene_;
  bool render_;
  MjcfOptions options_;
  pugi::xml_node root_;
};

}  // namespace

Result<std::string> scene_mjcf(const Scene& scene, std::string_view robot_mjcf, MjcfPurpose purpose,
                               const MjcfOptions& options) {
  pugi::xml_document document;
  if (robot_mjcf.empty()) robot_mjcf = "<mujoco model=\"scene\"/>";
  const auto parsed = document.load_buffer(robot_mjcf.data(), robot_mjcf.size());
  if (!parsed) {
    return failure(fmt::format("the robot's MJCF is not XML: {} at character {}",
                               parsed.description(), parsed.offset));
  }
  const pugi::xml_node root = document.child("mujoco");
  if (!root) return failure("the robot's MJCF has no <mujoco> element");
  SceneWriter(scene, purpose, options, root).write();
  std::ostringstream out;
  document.save(out, "  ");
  return out.str();
}

std::vector<float> height_field_data(const Floor& floor) {
  std::vector<float> elevations = floor.heights;
  if (elevations.empty()) return elevations;
  const float top = std::max(*std::max_element(elevations.begin(), elevations.end()), 1e-6F);
  for (float& elevation : elevations) elevation /= top;
  return elevations;
}

}  // namespace aims
