# SPDX-License-Identifier: BSD-3-Clause
# librosbag-storage without its own package files, which run a whole ROS build system:
#   RosbagStorage_FOUND, RosbagStorage::RosbagStorage
# The headers need C++17: as C++20 they do not compile.
find_path(RosbagStorage_INCLUDE_DIR rosbag/bag.h)
set(rosbag_parts rosbag_storage roscpp_serialization rostime cpp_common console_bridge class_loader
  ament_index_cpp rcpputils rcutils tinyxml2)
set(RosbagStorage_LIBRARIES "")
foreach(part ${rosbag_parts})
  find_library(RosbagStorage_${part}_LIBRARY ${part})
  list(APPEND RosbagStorage_LIBRARIES ${RosbagStorage_${part}_LIBRARY})
  list(APPEND rosbag_needed RosbagStorage_${part}_LIBRARY)
endforeach()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(RosbagStorage REQUIRED_VARS RosbagStorage_INCLUDE_DIR
  ${rosbag_needed})
if(RosbagStorage_FOUND AND NOT TARGET RosbagStorage::RosbagStorage)
  add_library(RosbagStorage::RosbagStorage INTERFACE IMPORTED)
  target_include_directories(RosbagStorage::RosbagStorage SYSTEM INTERFACE
    ${RosbagStorage_INCLUDE_DIR})
  foreach(part pluginlib class_loader rcutils rcpputils ament_index_cpp)
    if(IS_DIRECTORY ${RosbagStorage_INCLUDE_DIR}/${part})
      target_include_directories(RosbagStorage::RosbagStorage SYSTEM INTERFACE
        ${RosbagStorage_INCLUDE_DIR}/${part})
    endif()
  endforeach()
  target_link_libraries(RosbagStorage::RosbagStorage INTERFACE ${RosbagStorage_LIBRARIES})
endif()
