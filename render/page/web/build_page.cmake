# SPDX-License-Identifier: BSD-3-Clause
# Script: cmake -DWEB=render/page/web -DOUT=... -DNPM=... -DNODE=... -DREQUIRED=AUTO|ON -P build_page.cmake
#   -- modules   installs what package-lock.json names into OUT/node_modules, writes OUT/modules.stamp
#   -- page      bundles WEB into OUT/run.html, study.html and watch.html, writes their inputs to OUT/page.d
# Where that does not work, as without the registry, the pages are empty files: the build goes on,
# and `aims page` says so. With REQUIRED=ON it is an error instead.
math(EXPR last "${CMAKE_ARGC} - 1")
set(part ${CMAKE_ARGV${last}})

function(give_up what log)
  if(REQUIRED STREQUAL "ON")
    message(FATAL_ERROR "${what}:\n${log}")
  endif()
  message(WARNING "${what}: `aims page` will write no pages. Once npm works, remove ${OUT} and build again.\n${log}")
endfunction()

if(part STREQUAL "modules")
  file(MAKE_DIRECTORY ${OUT})
  configure_file(${WEB}/package.json ${OUT}/package.json COPYONLY)
  configure_file(${WEB}/package-lock.json ${OUT}/package-lock.json COPYONLY)
  execute_process(COMMAND ${NPM} ci --no-audit --no-fund --prefix ${OUT}
    RESULT_VARIABLE code OUTPUT_VARIABLE log ERROR_VARIABLE log)
  if(code EQUAL 0)
    file(WRITE ${OUT}/modules.stamp "installed\n")
  else()
    file(WRITE ${OUT}/modules.stamp "missing\n")
    give_up("npm ci failed" "${log}")
  endif()
  return()
endif()

# The inputs are whatever lies among the sources: a file that is added counts as well.
file(GLOB_RECURSE inputs ${WEB}/src/*)
list(SORT inputs)
list(JOIN inputs " \\\n  " inputs)
file(WRITE ${OUT}/page.d "${OUT}/run.html: \\\n  ${inputs}\n")
file(READ ${OUT}/modules.stamp installed)
if(NOT installed STREQUAL "installed\n")
  foreach(name run study watch)
    file(WRITE ${OUT}/${name}.html "")
  endforeach()
  return()
endif()
execute_process(COMMAND ${NODE} ${WEB}/build.mjs --modules ${OUT}/node_modules --out ${OUT}
  RESULT_VARIABLE code OUTPUT_VARIABLE log ERROR_VARIABLE log)
if(NOT code EQUAL 0)
  # Installed but not bundled is a mistake in the sources, whatever is required.
  message(FATAL_ERROR "bundling the pages failed:\n${log}")
endif()
