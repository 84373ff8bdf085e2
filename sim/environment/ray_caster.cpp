// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/ray_caster.hpp"

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <cstring>
#include <new>

#include "sim/environment/surface_relief.hpp"
#include "sim/environment/triangles.hpp"

namespace aims {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Rejects hits on glass away from normal incidence; the material is the user data.
void pass_through_glass(const RTCFilterFunctionNArguments* arguments) {
  const auto limit =
      static_cast<float>(static_cast<const Material*>(arguments->geometryUserPtr)->return_cosine);
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i) {
    if (arguments->valid[i] == 0) continue;
    const Eigen::Vector3f direction(RTCRayN_dir_x(arguments->ray, n, i),
                                    RTCRayN_dir_y(arguments->ray, n, i),
                                    RTCRayN_dir_z(arguments->ray, n, i));
    const Eigen::Vector3f normal(RTCHitN_Ng_x(arguments->hit, n, i),
                                 RTCHitN_Ng_y(arguments->hit, n, i),
                                 RTCHitN_Ng_z(arguments->hit, n, i));
    if (std::abs(direction.dot(normal)) < limit * normal.norm()) arguments->valid[i] = 0;
  }
}

/// Embree states a lack of memory by an error of the device.
void check_memory(RTCDevice device) {
  if (rtcGetDeviceError(device) == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
}

void attach(RTCDevice device, RTCScene scene, const TriangleMesh& mesh, unsigned surface,
            const Material& material) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               mesh.vertices.size()));
  check_memory(device);
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) *vertices++ = vertex[axis];
  }
  auto* indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), mesh.triangles.size()));
  check_memory(device);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) *indices++ = index;
  }
  if (material.return_cosine > 0.0) {
    // Embree hands the pointer back as it was given; nothing writes through it.
    rtcSetGeometryUserData(geometry, const_cast<Material*>(&material));
    rtcSetGeometryIntersectFilterFunction(geometry, pass_through_glass);
  }
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, surface);
  rtcReleaseGeometry(geometry);
}

/// Builds within the calling thread. The device's own thread limit is not used: it would hold
/// for the whole process.
void commit(RTCScene scene) {
  tbb::task_arena arena(1);
  arena.execute([&] { rtcCommitScene(scene); });
}

void prepare(const RayPacket& rays, float max_distance, RTCRayHit16& packet) {
  RTCRay16& ray = packet.ray;
  std::memcpy(ray.org_x, rays.origin_x.data(), sizeof(ray.org_x));
  std::memcpy(ray.org_y, rays.origin_y.data(), sizeof(ray.org_y));
  std::memcpy(ray.org_z, rays.origin_z.data(), sizeof(ray.org_z));
  std::memcpy(ray.dir_x, rays.direction_x.data(), sizeof(ray.dir_x));
  std::memcpy(ray.dir_y, rays.direction_y.data(), sizeof(ray.dir_y));
  std::memcpy(ray.dir_z, rays.direction_z.data(), sizeof(ray.dir_z));
  for (int i = 0; i < kRayPacketSize; ++i) {
    ray.tnear[i] = 0.0F;
    ray.time[i] = 0.0F;
    ray.tfar[i] = max_distance;
    ray.mask[i] = ~0U;
    ray.id[i] = 0;
    ray.flags[i] = 0;
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
}

/// Copies the hits; normals become unit vectors towards the ray's origin.
void extract(const RTCRayHit16& packet, const RayPacket& rays, HitPacket& hits) {
  const RTCHit16& hit = packet.hit;
  for (int i = 0; i < kRayPacketSize; ++i) {
    const bool any = hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
    const float x = any ? hit.Ng_x[i] : 0.0F;
    const float y = any ? hit.Ng_y[i] : 0.0F;
    const float z = any ? hit.Ng_z[i] : 1.0F;
    const float along = x * rays.direction_x[i] + y * rays.direction_y[i] + z * rays.direction_z[i];
    const float scale = (along > 0.0F ? -1.0F : 1.0F) / std::sqrt(x * x + y * y + z * z);
    hits.normal_x[i] = scale * x;
    hits.normal_y[i] = scale * y;
    hits.normal_z[i] = scale * z;
    hits.distance[i] = any ? packet.ray.tfar[i] : kInfinity;
    hits.surface[i] = static_cast<int>(hit.geomID[i]);  // the invalid id becomes -1
  }
}

/// Moves the hit of a single ray onto the relief.
RayHit displaced(const SurfaceRelief& relief, const Eigen::Vector3f& origin,
                 const Eigen::Vector3f& direction, const RayHit& hit) {
  RayPacket rays;
  HitPacket hits;
  hits.surface.fill(-1);
  rays.origin_x[0] = origin.x();
  rays.origin_y[0] = origin.y();
  rays.origin_z[0] = origin.z();
  rays.direction_x[0] = direction.x();
  rays.direction_y[0] = direction.y();
  rays.direction_z[0] = direction.z();
  hits.distance[0] = static_cast<float>(hit.distance);
  hits.normal_x[0] = static_cast<float>(hit.normal.x());
  hits.normal_y[0] = static_cast<float>(hit.normal.y());
  hits.normal_z[0] = static_cast<float>(hit.normal.z());
  hits.surface[0] = hit.surface;
  relief.displace(rays, hits);
  return {hits.distance[0], {hits.normal_x[0], hits.normal_y[0], hits.normal_z[0]}, hit.surface};
}

}  // namespace

struct RayCaster::Impl {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = rtcNewScene(device);
  std::vector<Material> materials;
  std::vector<Person> people;
  std::optional<SurfaceRelief> relief;
  std::size_t triangle_count = 0;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }

  /// `materials` must have room: glass keeps a pointer to its own.
  void add(const TriangleMesh& mesh, const Material& material, bool visible) {
    const auto surface = static_cast<unsigned>(materials.size());
    materials.push_back(material);
    if (!visible) return;
    attach(device, scene, mesh, surface, materials.back());
    triangle_count += mesh.triangles.size();
  }
};

RayCaster::RayCaster(const Scene& scene) : impl_(std::make_unique<Impl>()) {
  rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(impl_->scene, RTC_BUILD_QUALITY_HIGH);
  impl_->people = scene.people;
  impl_->materials.reserve(scene.solids.size() + 1);
  for (const Solid& solid : scene.solids) {
    impl_->add(triangulate(solid), solid.material, solid.visible);
  }
  impl_->add(triangulate(scene.floor), scene.floor.material, true);
  commit(impl_->scene);
  check_memory(impl_->device);
  if (!scene.surface.is_plain()) {
    impl_->relief.emplace(scene.surface, scene, scene.surface_seed);
  }
}

RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;
RayCaster::~RayCaster() = default;

void RayCaster::cast(const RayPacket& rays, float max_distance, HitPacket& hits, int count) const {
  alignas(64) std::array<int, kRayPacketSize> valid;
  for (int i = 0; i < kRayPacketSize; ++i) valid[i] = i < count ? -1 : 0;
  alignas(64) RTCRayHit16 packet;
  prepare(rays, max_distance, packet);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid.data(), impl_->scene, &context, &packet);
  extract(packet, rays, hits);
  if (impl_->relief) impl_->relief->displace(rays, hits);
}

std::optional<RayHit> RayCaster::cast(const Eigen::Vector3d& origin,
                                      const Eigen::Vector3d& direction, double max_distance) const {
  RTCRayHit single{};
  const Eigen::Vector3f from = origin.cast<float>();
  const Eigen::Vector3f towards = direction.cast<float>();
  single.ray = {.org_x = from.x(),
                .org_y = from.y(),
                .org_z = from.z(),
                .tnear = 0.0F,
                .dir_x = towards.x(),
                .dir_y = towards.y(),
                .dir_z = towards.z(),
                .time = 0.0F,
                .tfar = static_cast<float>(max_distance),
                .mask = ~0U,
                .id = 0,
                .flags = 0};
  single.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  single.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(impl_->scene, &context, &single);
  if (single.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  Eigen::Vector3d normal =
      Eigen::Vector3d(single.hit.Ng_x, single.hit.Ng_y, single.hit.Ng_z).normalized();
  if (normal.dot(direction) > 0.0) normal = -normal;
  const auto surface = static_cast<int>(single.hit.geomID);
  const RayHit hit{single.ray.tfar, normal, surface};
  return impl_->relief ? displaced(*impl_->relief, from, towards, hit) : hit;
}

const std::vector<Material>& RayCaster::materials() const { return impl_->materials; }

const std::vector<Person>& RayCaster::people() const { return impl_->people; }

bool RayCaster::has_relief() const { return impl_->relief.has_value(); }

std::size_t RayCaster::triangle_count() const { return impl_->triangle_count; }

}  // namespace aims
