// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/surface_distance.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "sim/environment/triangles.hpp"

namespace aims {
namespace {

using Eigen::Vector3f;

float squared_distance_to_edge(const Vector3f& p, const Vector3f& a, const Vector3f& b) {
  const Vector3f edge = b - a;
  const float length = edge.squaredNorm();
  const float along = length > 0.0F ? std::clamp((p - a).dot(edge) / length, 0.0F, 1.0F) : 0.0F;
  return (p - a - along * edge).squaredNorm();
}

void append(const TriangleMesh& part, TriangleMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const auto& [a, b, c] : part.triangles) {
    mesh.triangles.push_back({first + a, first + b, first + c});
  }
}

TriangleMesh surface_of(const Scene& scene) {
  TriangleMesh mesh = triangulate(scene.floor);
  for (const Solid& solid : scene.solids) {
    if (solid.visible) append(triangulate(solid), mesh);
  }
  return mesh;
}

void fill_buffers(RTCGeometry geometry, const TriangleMesh& mesh) {
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               mesh.vertices.size()));
  std::memcpy(vertices, mesh.vertices.data(), mesh.vertices.size() * sizeof(Vector3f));
  auto* indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), mesh.triangles.size()));
  std::memcpy(indices, mesh.triangles.data(), mesh.triangles.size() * 3 * sizeof(std::uint32_t));
}

/// Shrinks the query's radius to the triangle's distance where that is less.
bool meet_triangle(RTCPointQueryFunctionArguments* arguments) {
  const auto& mesh = *static_cast<const TriangleMesh*>(arguments->userPtr);
  const auto& [a, b, c] = mesh.triangles[arguments->primID];
  RTCPointQuery& query = *arguments->query;
  const float distance = std::sqrt(squared_distance({query.x, query.y, query.z}, mesh.vertices[a],
                                                    mesh.vertices[b], mesh.vertices[c]));
  if (distance >= query.radius) return false;
  query.radius = distance;
  return true;
}

}  // namespace

float squared_distance(const Vector3f& p, const Vector3f& a, const Vector3f& b, const Vector3f& c) {
  const Vector3f normal = (b - a).cross(c - a);
  const float area = normal.squaredNorm();
  const bool above = area > 0.0F && (b - a).cross(p - a).dot(normal) >= 0.0F &&
                     (c - b).cross(p - b).dot(normal) >= 0.0F &&
                     (a - c).cross(p - c).dot(normal) >= 0.0F;
  if (above) {
    const float height = (p - a).dot(normal);
    return height * height / area;
  }
  return std::min({squared_distance_to_edge(p, a, b), squared_distance_to_edge(p, b, c),
                   squared_distance_to_edge(p, c, a)});
}

struct SurfaceDistance::Impl {
  TriangleMesh mesh;
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = rtcNewScene(device);

  explicit Impl(const Scene& surroundings) : mesh(surface_of(surroundings)) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    fill_buffers(geometry, mesh);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

SurfaceDistance::SurfaceDistance(const Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}
SurfaceDistance::SurfaceDistance(SurfaceDistance&&) noexcept = default;
SurfaceDistance& SurfaceDistance::operator=(SurfaceDistance&&) noexcept = default;
SurfaceDistance::~SurfaceDistance() = default;

float SurfaceDistance::operator()(const Vector3f& p_world, float limit) const {
  RTCPointQuery query = {p_world.x(), p_world.y(), p_world.z(), 0.0F, limit};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(impl_->scene, &query, &context, meet_triangle, &impl_->mesh);
  return query.radius;
}

}  // namespace aims
