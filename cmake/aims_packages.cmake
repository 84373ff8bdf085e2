# SPDX-License-Identifier: BSD-3-Clause
# `cpack -G DEB` in the build folder: aims_VERSION_ARCH.deb, the program; libaims-dev_..., for
# programs of others; where they were built, aims-live_... and aims-node_..., for the robot, and
# python3-aims_... and python3-aims-sim_....
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME aims)
set(CPACK_PACKAGE_VENDOR "the AIMS authors")
set(CPACK_PACKAGE_CONTACT "the AIMS authors <aims@localhost>")
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL "")
if(NOT AIMS_ROBOT_ONLY)
  list(APPEND CPACK_COMPONENTS_ALL runtime dev)
endif()
if(TARGET aims_live)
  list(APPEND CPACK_COMPONENTS_ALL live)
endif()
if(TARGET aims_node)
  list(APPEND CPACK_COMPONENTS_ALL ros)
endif()
if(TARGET aims_python_core)
  list(APPEND CPACK_COMPONENTS_ALL python python_sim)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME aims)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION science)
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION
  "legged-robot localization in degenerate corridors
Simulates a quadruped, runs estimators on simulated or recorded data, scores
any system's trajectory against a truth, and draws what happened.")
# Libraries are found by dpkg-shlibdeps, but for SQLite, which is loaded; fonts are for pictures.
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS "fonts-dejavu-core, libsqlite3-0")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS aims-live)  # of `aims live`, `play` and `watch`

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libaims-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEV_DESCRIPTION
  "legged-robot localization in degenerate corridors, libraries
Estimators, readers of recordings and trajectory scoring as static libraries
with headers; CMake finds them by find_package(aims CONFIG).")
# What aimsConfig.cmake finds.
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libboost-dev, libbz2-dev, libeigen3-dev, libexpected-dev, \
libfmt-dev, liblz4-dev, libyaml-cpp-dev, libzstd-dev, \
pkg-config, zlib1g-dev")

set(CPACK_DEBIAN_LIVE_PACKAGE_NAME aims-live)
set(CPACK_DEBIAN_LIVE_PACKAGE_SECTION science)
set(CPACK_COMPONENT_LIVE_DESCRIPTION
  "legged-robot localization in degenerate corridors, live under ROS 2
Estimates a legged robot's motion live from ROS 2 topics, shows it in a browser,
and plays recordings. Speaks DDS: needs neither ROS nor anything of the simulation.")
set(CPACK_DEBIAN_LIVE_PACKAGE_SHLIBDEPS ON)

set(CPACK_DEBIAN_ROS_PACKAGE_NAME aims-node)
set(CPACK_DEBIAN_ROS_PACKAGE_SECTION science)
set(CPACK_COMPONENT_ROS_DESCRIPTION
  "legged-robot localization in degenerate corridors, ROS 1 node
Estimates a legged robot's motion live from its LiDAR, IMU and legs. Needs
nothing of the simulation.")
set(CPACK_DEBIAN_ROS_PACKAGE_SHLIBDEPS ON)

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-aims)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_COMPONENT_PYTHON_DESCRIPTION
  "legged-robot localization in degenerate corridors, Python package
Estimators, recordings and scores with NumPy arrays. Needs nothing of the
simulation.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
# An extension module is for one minor version of Python.
if(Python3_VERSION_MINOR)
  math(EXPR python_next "${Python3_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "python3 (>= 3.${Python3_VERSION_MINOR}), python3 (<< 3.${python_next}), python3-numpy")
endif()
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-aims-sim, python3-pandas, python3-matplotlib")

set(CPACK_DEBIAN_PYTHON_SIM_PACKAGE_NAME python3-aims-sim)
set(CPACK_DEBIAN_PYTHON_SIM_PACKAGE_SECTION python)
set(CPACK_COMPONENT_PYTHON_SIM_DESCRIPTION
  "legged-robot localization in degenerate corridors, simulation for Python
Scenarios and the simulated robot, for the package python3-aims.")
set(CPACK_DEBIAN_PYTHON_SIM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON_SIM_PACKAGE_DEPENDS
  "python3-aims (= ${PROJECT_VERSION}), aims (= ${PROJECT_VERSION})")
include(CPack)
