// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/config.hpp"

namespace aims::testing {

/// A configuration with every kind of field.
enum class Model { kPoint, kRolling };

struct Waypoint {
  std::string name = "p";
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  std::vector<std::string> tags;
};

struct Inner {
  double eta = 3.0;
  int count = 5;
  bool enabled = true;
  Model model = Model::kPoint;
};

struct Sample {
  std::string name = "corridor";
  Eigen::Vector3d gravity = Eigen::Vector3d(0.0, 0.0, -9.81);
  std::vector<std::string> estimators = {"aims", "lio"};
  Inner inner;
  std::vector<Waypoint> points = std::vector<Waypoint>(1);
};

inline void describe(Fields& f, Waypoint& c) {
  f.text("name", c.name, {.meaning = "Name."});
  f.vector("position", c.position, {.unit = "m", .meaning = "Place."});
  f.texts("tags", c.tags, {.meaning = "Tags."});
}

inline void describe(Fields& f, Inner& c) {
  f.number("eta", c.eta,
           {.unit = "-", .range = up_to(100.0), .meaning = "Sensitivity.", .source = "eq. (8)"});
  f.integer("count", c.count, {.range = in_range(1, 9), .meaning = "Count."});
  f.flag("enabled", c.enabled, {.meaning = "Switch."});
  f.choice("model", c.model, {{"point", Model::kPoint}, {"rolling", Model::kRolling}},
           {.meaning = "Foot."});
}

inline void describe(Fields& f, Sample& c) {
  f.text("name", c.name, {.meaning = "Name."});
  f.vector("gravity", c.gravity, {.unit = "m/s^2", .meaning = "Gravity."});
  f.texts("estimators", c.estimators, {.meaning = "Who runs."});
  f.group("inner", c.inner);
  f.list("points", c.points, "Route.");
}

}  // namespace aims::testing
