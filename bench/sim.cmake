# SPDX-License-Identifier: BSD-3-Clause
aims_bench(sim_walk SOURCES sim_walk.cpp LINKS aims::sim)
