# SPDX-License-Identifier: BSD-3-Clause
if(NOT TARGET aims::kinematic_world)
  add_subdirectory(${PROJECT_SOURCE_DIR}/tests/support ${PROJECT_BINARY_DIR}/tests/support)
endif()
aims_bench(estimator SOURCES estimator_bench.cpp LINKS aims::estimator aims::kinematic_world)
