# SPDX-License-Identifier: BSD-3-Clause
aims_bench(render SOURCES render_pictures.cpp LINKS aims::render)
