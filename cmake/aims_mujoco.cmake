# SPDX-License-Identifier: BSD-3-Clause
# mujoco::mujoco of Debian 12, whose target names an include folder of a package that it does not
# depend on (libqhull) and does not need.
find_package(mujoco REQUIRED)
get_target_property(include_folders mujoco::mujoco INTERFACE_INCLUDE_DIRECTORIES)
list(FILTER include_folders EXCLUDE REGEX "libqhull")
set_target_properties(mujoco::mujoco PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${include_folders}")
