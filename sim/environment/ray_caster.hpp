// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "sim/environment/scene.hpp"

namespace aims {

inline constexpr int kRayPacketSize = 16;

/// Sixteen rays in the world frame; directions are unit vectors.
struct alignas(64) RayPacket {
  using Lanes = std::array<float, kRayPacketSize>;
  Lanes origin_x{}, origin_y{}, origin_z{};           ///< [m]
  Lanes direction_x{}, direction_y{}, direction_z{};  ///< [-]
};

/// The first hits of sixteen rays.
struct alignas(64) HitPacket {
  using Lanes = std::array<float, kRayPacketSize>;
  Lanes distance{};                           ///< [m]; infinity: no hit within the range
  Lanes normal_x{}, normal_y{}, normal_z{};   ///< unit, towards the ray's origin
  std::array<int, kRayPacketSize> surface{};  ///< index into `RayCaster::materials`; -1: no hit
  /// Factor of the reflectivity of the material; set where the scene has a relief or a texture.
  Lanes texture{};
};

inline Eigen::Vector3f normal_of(const HitPacket& hits, int lane) {
  return {hits.normal_x[lane], hits.normal_y[lane], hits.normal_z[lane]};
}

/// The first hit of one ray.
struct RayHit {
  double distance = 0.0;                              ///< [m]
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, towards the ray's origin
  int surface = 0;                                    ///< index into `RayCaster::materials`
};

/// Finds the first hits of rays on the visible solids and the floor of a scene. A ray passes
/// through glass unless it is near normal incidence (`Material::return_cosine`). Casting is
/// thread-safe, starts no threads, and yields the same bits for the same scene and rays.
class RayCaster {
 public:
  explicit RayCaster(const Scene& scene);
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;
  ~RayCaster();

  /// Casts the first `count` rays of the packet up to `max_distance` [m]; neighbouring
  /// directions in one packet are fastest. Lanes beyond `count` yield no hit.
  void cast(const RayPacket& rays, float max_distance, HitPacket& hits,
            int count = kRayPacketSize) const;

  /// Casts one ray with unit `direction` (world frame).
  std::optional<RayHit> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                             double max_distance = std::numeric_limits<double>::infinity()) const;

  /// Materials by surface: those of the scene's solids in order, then the floor's.
  const std::vector<Material>& materials() const;
  /// The surface that is the floor.
  int floor_surface() const { return static_cast<int>(materials().size()) - 1; }
  std::size_t triangle_count() const;
  /// Whether hits of the static scene have a `HitPacket::texture`.
  bool has_relief() const;

  /// The scene's people. They move and are not part of the static scene; see `intersect_people`.
  const std::vector<Person>& people() const;
  /// Surface index of the first person; the others follow. All moving surfaces come from there on.
  int first_moving_surface() const { return static_cast<int>(materials().size()); }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aims
