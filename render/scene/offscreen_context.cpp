// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/offscreen_context.hpp"

#include <GL/osmesa.h>

#include <array>
#include <utility>

namespace aims {

struct OffscreenContext::Impl {
  OSMesaContext context = nullptr;
  // Mesa wants a window of its own; the pictures are drawn to MuJoCo's off-screen buffer.
  std::array<unsigned char, 64 * 64 * 4> window{};

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (context != nullptr) OSMesaDestroyContext(context);
  }
};

OffscreenContext::OffscreenContext(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
OffscreenContext::OffscreenContext(OffscreenContext&&) noexcept = default;
OffscreenContext& OffscreenContext::operator=(OffscreenContext&&) noexcept = default;
OffscreenContext::~OffscreenContext() = default;

Result<OffscreenContext> OffscreenContext::create() {
  auto impl = std::make_unique<Impl>();
  impl->context = OSMesaCreateContextExt(OSMESA_RGBA, 24, 8, 0, nullptr);
  if (impl->context == nullptr) {
    return failure("cannot make an off-screen OpenGL context: OSMesaCreateContextExt failed");
  }
  if (OSMesaMakeCurrent(impl->context, impl->window.data(), GL_UNSIGNED_BYTE, 64, 64) != GL_TRUE) {
    return failure("cannot make an off-screen OpenGL context: OSMesaMakeCurrent failed");
  }
  return OffscreenContext(std::move(impl));
}

}  // namespace aims
