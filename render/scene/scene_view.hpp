// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "render/plots/image.hpp"
#include "render/plots/palette.hpp"
#include "render/scene/view_overlay.hpp"

namespace aims {

/// Where a picture is taken from: on a sphere around what it looks at.
struct Camera {
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< in the middle of the picture [m]
  double distance = 2.0;                             ///< from the target [m]
  double azimuth_deg = 0.0;    ///< heading of the view; 0 looks along +x, 90 along +y
  double elevation_deg = 0.0;  ///< of the view; negative looks down

  Eigen::Vector3d position() const;  ///< of the eye [m]
};

/// Size and quality of pictures.
struct ViewConfig {
  int width = 1280;  ///< [px]
  int height = 720;  ///< [px]
  int samples = 4;   ///< per pixel; 0: edges are not smoothed
  bool shadows = true;
  std::optional<Color> sky =
      std::nullopt;  ///< one colour for the background; none: that of the document
};

/// A MuJoCo model ready to be drawn in any configuration. Stays in the thread that made it.
class SceneView {
 public:
  /// `mjcf`: the complete document; `height_field`: elevations in [0, 1] of its first height field,
  /// may be empty. Error when MuJoCo rejects the document or there is no OpenGL context.
  static Result<SceneView> create(const std::string& mjcf, const std::vector<float>& height_field,
                                  const ViewConfig& config = {});
  SceneView(SceneView&&) noexcept;
  SceneView& operator=(SceneView&&) noexcept;
  ~SceneView();

  /// The picture with the joints at `qpos` and the overlay's dots and lines. Error when `qpos` has
  /// the wrong length or is not finite.
  Result<Image> draw(const std::vector<double>& qpos, const Camera& camera,
                     const ViewOverlay& overlay = {});

 private:
  struct Impl;
  explicit SceneView(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace aims
