// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/random.hpp"
#include "sim/environment/building_config.hpp"
#include "sim/environment/ray_caster.hpp"
#include "sim/environment/scene.hpp"

namespace aims {

/// Heights and reflectivities of a plane that repeat after kColumns cells along u and kRows along
/// v, bilinear between the nodes of a grid. One read of 4 bytes gives both at a node.
class SurfaceTable {
 public:
  using Lanes = RayPacket::Lanes;

  static constexpr float kCell = 0.04F;  ///< [m]
  static constexpr int kColumns = 2048;
  static constexpr int kRows = 256;

  /// Values and slopes at sixteen points.
  struct Samples {
    alignas(64) Lanes height{};   ///< [m]
    alignas(64) Lanes slope_u{};  ///< [-]
    alignas(64) Lanes slope_v{};  ///< [-]
    alignas(64) Lanes factor{};   ///< of the reflectivity [-]
  };

  /// Gaussian fields of the configuration: heights, and the logarithm of the factor.
  SurfaceTable(const SurfaceConfig& config, std::uint64_t seed);

  /// At (u, v) [m]; coordinates beyond 10 km are undefined.
  void sample(const Lanes& u, const Lanes& v, Samples& samples) const;

 private:
  static constexpr int kStride = kColumns + 1;  ///< the first column and row again at the end

  float height_unit_ = 0.0F;           ///< [m]
  float factor_unit_ = 0.0F;           ///< [-]
  std::vector<std::uint32_t> texels_;  ///< row by row: 16 bits of the factor over 16 of the height
};

/// Displaces rays' hits on the boxes and the floor of a scene by the relief of their surfaces, to
/// first order along each ray; cylinders, glass and people stay as they are. Reliefs of
/// neighbouring solids are independent. Joints of panels (`PanelConfig`) are on upright faces.
/// Nothing else sees it: the feet walk on planes, and pictures show them.
class SurfaceRelief {
 public:
  SurfaceRelief(const SurfaceConfig& config, const Scene& scene, std::uint64_t seed);

  /// Moves the hits of a packet along their rays and tilts their normals; sets their texture.
  void displace(const RayPacket& rays, HitPacket& hits) const;

 private:
  /// Where a face of a box is cut out of the fields.
  struct Face {
    Eigen::Vector3f u;              ///< unit, world
    Eigen::Vector3f v;              ///< unit, world
    float offset_u = 0.0F;          ///< [m]
    float offset_v = 0.0F;          ///< [m]
    bool has_panels = false;        ///< with joints
    float offset_of_joints = 0.0F;  ///< along u [m]
  };
  struct Box {
    bool smooth = true;
    Eigen::Matrix3f axes = Eigen::Matrix3f::Identity();  ///< columns: normals of the faces
    std::array<Face, 3> faces;                           ///< by normal
  };

  void add(const Eigen::Matrix3d& R, const Eigen::Vector3d& half_extents, bool smooth,
           RandomStream& offsets, RandomStream& joints);
  const Face& face_of(const Box& box, const Eigen::Vector3f& normal) const;
  void displace_on(const Face& face, const RayPacket& rays, int first, int last,
                   HitPacket& hits) const;
  void sample(const Face& face, const SurfaceTable::Lanes& u, const SurfaceTable::Lanes& v,
              SurfaceTable::Samples& samples) const;

  SurfaceTable table_;
  PanelConfig panels_;
  std::vector<Box> boxes_;  ///< by surface
};

}  // namespace aims
