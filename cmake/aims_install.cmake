# SPDX-License-Identifier: BSD-3-Clause
# What was built is installed, in components; what was not is named. `runtime`: the program with its scenarios and scripts. `ros` and `live`:
# the live programs for ROS 1 and ROS 2 (live/CMakeLists.txt). `python` and `python_sim`: the Python package without and with the
# simulation (python/CMakeLists.txt). `dev`: the libraries that another program needs to estimate, read
# recordings and score. Simulation and rendering stay inside the program: neither `ros`, `live`, `python`
# nor `dev` depends on MuJoCo, Embree, pagmo or SQLite.
include(CMakePackageConfigHelpers)

set(exported_libraries core files estimator metrics recordings)
set(cmake_folder ${CMAKE_INSTALL_LIBDIR}/cmake/aims)

install(TARGETS aims RUNTIME COMPONENT runtime OPTIONAL)
aims_say_left_out(aims runtime "the program aims")
install(DIRECTORY scenarios DESTINATION ${CMAKE_INSTALL_DATADIR}/aims COMPONENT runtime
  FILES_MATCHING PATTERN "*.yaml")
install(DIRECTORY models/datasets DESTINATION ${CMAKE_INSTALL_DATADIR}/aims COMPONENT runtime
  FILES_MATCHING PATTERN "*.yaml")
install(DIRECTORY scripts/slurm DESTINATION ${CMAKE_INSTALL_DATADIR}/aims COMPONENT runtime
  USE_SOURCE_PERMISSIONS)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/aims RENAME copyright
  COMPONENT runtime)
aims_install_with(aims runtime ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
  FILES ${PROJECT_BINARY_DIR}/completions/aims)
aims_install_with(aims runtime ${CMAKE_INSTALL_DATADIR}/zsh/site-functions
  FILES ${PROJECT_BINARY_DIR}/completions/_aims)

# Includes are written from the root of the sources, "core/lie.hpp"; include/aims is that root.
foreach(library ${exported_libraries})
  set_target_properties(aims_${library} PROPERTIES EXPORT_NAME ${library})
  target_compile_features(aims_${library} PUBLIC cxx_std_20)
  install(TARGETS aims_${library} EXPORT aims ARCHIVE COMPONENT dev
    INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/aims)
endforeach()
foreach(folder core estimator recordings bench/metrics)
  get_filename_component(parent ${folder} DIRECTORY)
  install(DIRECTORY ${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/aims/${parent} COMPONENT dev
    FILES_MATCHING PATTERN "*.hpp")
endforeach()
install(EXPORT aims NAMESPACE aims:: FILE aimsTargets.cmake DESTINATION ${cmake_folder}
  COMPONENT dev)
configure_package_config_file(cmake/aimsConfig.cmake.in ${PROJECT_BINARY_DIR}/aimsConfig.cmake
  INSTALL_DESTINATION ${cmake_folder} NO_SET_AND_CHECK_MACRO)
# Before 1.0 a minor version may change anything.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/aimsConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/aimsConfig.cmake ${PROJECT_BINARY_DIR}/aimsConfigVersion.cmake
  DESTINATION ${cmake_folder} COMPONENT dev)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libaims-dev RENAME copyright
  COMPONENT dev)
if(TARGET aims_python_core AND NOT SKBUILD)
  aims_install_with(aims_python_core python ${CMAKE_INSTALL_DATADIR}/doc/python3-aims
    FILES ${PROJECT_SOURCE_DIR}/LICENSE RENAME copyright)
  aims_install_with(aims_python_sim python_sim ${CMAKE_INSTALL_DATADIR}/doc/python3-aims-sim
    FILES ${PROJECT_SOURCE_DIR}/LICENSE RENAME copyright)
endif()
include(cmake/aims_install_live.cmake)
