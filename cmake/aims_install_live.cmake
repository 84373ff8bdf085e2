# SPDX-License-Identifier: BSD-3-Clause
# The licence in the packages of the live programs.
if(TARGET aims_live)
  aims_install_with(aims_live live ${CMAKE_INSTALL_DATADIR}/doc/aims-live
    FILES ${PROJECT_SOURCE_DIR}/LICENSE RENAME copyright)
endif()
if(TARGET aims_node)
  aims_install_with(aims_node ros ${CMAKE_INSTALL_DATADIR}/doc/aims-node
    FILES ${PROJECT_SOURCE_DIR}/LICENSE RENAME copyright)
endif()
