// SPDX-License-Identifier: BSD-3-Clause
/** Entry of the page of a run. */
import { renderRun } from "./run/page";
import { startPage } from "./start_page";

void startPage({ run: renderRun });
