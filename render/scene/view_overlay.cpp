// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/view_overlay.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

namespace aims {
namespace {

void prepare(const ViewOverlay& overlay) {
  for (const GLenum what : {GL_LIGHTING, GL_TEXTURE_2D, GL_TEXTURE_CUBE_MAP, GL_CULL_FACE,
                            GL_TEXTURE_GEN_S, GL_TEXTURE_GEN_T, GL_COLOR_MATERIAL}) {
    glDisable(what);
  }
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glEnable(GL_FOG);
  glFogi(GL_FOG_MODE, GL_LINEAR);
  glFogf(GL_FOG_START, overlay.haze_from);
  glFogf(GL_FOG_END, overlay.haze_to);
  const std::array<float, 4> haze = {overlay.haze[0], overlay.haze[1], overlay.haze[2], 1.0F};
  glFogfv(GL_FOG_COLOR, haze.data());
}

/// Points shrink with their distance as solids do.
void draw_points(const ViewOverlay& overlay, float focal_length) {
  if (overlay.points.empty()) return;
  const float per_distance = 1.0F / (focal_length * focal_length);
  const std::array<float, 3> attenuation = {0.0F, 0.0F, per_distance};
  glPointParameterfv(GL_POINT_DISTANCE_ATTENUATION, attenuation.data());
  glPointParameterf(GL_POINT_SIZE_MIN, overlay.least_diameter);
  glPointSize(overlay.point_diameter);
  glEnableClientState(GL_VERTEX_ARRAY);
  glEnableClientState(GL_COLOR_ARRAY);
  glVertexPointer(3, GL_FLOAT, sizeof(ViewPoint), overlay.points.front().position.data());
  glColorPointer(4, GL_UNSIGNED_BYTE, sizeof(ViewPoint), overlay.points.front().color.data());
  glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(overlay.points.size()));
}

void draw_lines(const ViewOverlay& overlay) {
  for (const ViewLine& line : overlay.lines) {
    glLineWidth(line.width);
    glColor4ubv(line.color.data());
    glBegin(GL_LINE_STRIP);
    for (const Eigen::Vector3f& point : line.points) glVertex3fv(point.data());
    glEnd();
  }
}

}  // namespace

void draw_overlay(const ViewOverlay& overlay, float focal_length) {
  glPushAttrib(GL_ALL_ATTRIB_BITS);
  glPushClientAttrib(GL_CLIENT_ALL_ATTRIB_BITS);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
  for (const GLenum array : {GL_NORMAL_ARRAY, GL_TEXTURE_COORD_ARRAY, GL_COLOR_ARRAY}) {
    glDisableClientState(array);
  }
  prepare(overlay);
  draw_points(overlay, focal_length);
  draw_lines(overlay);
  glPopClientAttrib();
  glPopAttrib();
}

}  // namespace aims
