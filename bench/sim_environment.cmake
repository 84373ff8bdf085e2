# SPDX-License-Identifier: BSD-3-Clause
aims_bench(sim_environment_lidar SOURCES sim_environment_lidar.cpp LINKS aims::sim_environment)
