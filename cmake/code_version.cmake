# SPDX-License-Identifier: BSD-3-Clause
# Script: cmake -DROOT=... -DBUILD=... -DOUT=... -P code_version.cmake
# Writes OUT, a source file with the hash of everything that decides what a run yields: the sources of the
# libraries that simulate, estimate and score, the robot, and what compiled them; and with that of what
# simulates alone. Only contents and names inside the project count; OUT changes only when a hash does.
set(digest "${BUILD}")
foreach(folder core sim models estimator bench)
  file(GLOB_RECURSE files RELATIVE ${ROOT} "${ROOT}/${folder}/*.hpp" "${ROOT}/${folder}/*.cpp"
    "${ROOT}/${folder}/*.in" "${ROOT}/${folder}/*.xml")
  list(FILTER files EXCLUDE REGEX "^core/files/")
  if(folder STREQUAL "bench")  # the rest of it selects, stores and prints
    list(FILTER files INCLUDE REGEX
      "^bench/(metrics/|scenario/sequence_record\\.|scoring/(score_list|score_record|timed_estimator|result_files|tables)\\.|estimate/stream\\.|run/(run[a-z_]*|evaluate|sequence[a-z_]*|weak_axis_series)\\.)")
  endif()
  list(SORT files)
  foreach(file ${files})
    file(SHA256 "${ROOT}/${file}" hash)
    string(APPEND digest "\n${file} ${hash}")
  endforeach()
  if(folder STREQUAL "models")
    string(SHA256 simulator_version "${digest}")
  endif()
endforeach()
string(SHA256 version "${digest}")
string(SUBSTRING ${version} 0 16 version)
string(SUBSTRING ${simulator_version} 0 16 simulator_version)
set(text "// Written by cmake/code_version.cmake.
#include \"bench/run/code_version.hpp\"

namespace aims {
std::string_view code_version() { return \"${version}\"; }
std::string_view simulator_version() { return \"${simulator_version}\"; }
}  // namespace aims
")
set(old "")
if(EXISTS ${OUT})
  file(READ ${OUT} old)
endif()
if(NOT old STREQUAL text)
  file(WRITE ${OUT} "${text}")
endif()
