# SPDX-License-Identifier: BSD-3-Clause
aims_bench(run SOURCES harness_run.cpp LINKS aims::harness)
