// SPDX-License-Identifier: BSD-3-Clause
/** Entry of the page of a suite, a sweep or a tuning. */
import { startPage } from "./start_page";
import { renderSuite } from "./suite/suite";
import { renderTuning } from "./tuning/tuning";

void startPage({ suite: renderSuite, tuning: renderTuning });
