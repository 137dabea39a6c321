/* table.h - a sweep's results as one table: NAME.csv, and NAME.h5 with a dataset for each column.
 *
 * Columns: `run` (from 1); the varied keys, in SI where all their values are numbers; `status`; what is collected; with `best`
 * a last one, `best`, 1 of the best run and 0 of the others. Three numbers are NAME.x, NAME.y, NAME.z, others NAME[0], ..; of
 * what has a row for each time, stage or evaluation (probes, history, stages, frames) it is the last row. What is not there
 * is an empty cell, and NaN. More than 64 numbers are a dataset [runs, ..] of NAME.h5 only. */
#pragma once
#include "base/error.h"
#include "job/host.h"
#include "sweep/sweep.h"

/* Writes both files, with the sweep's folder beside them, and makes NAME/best.vtkhdf a link to the best run's result.
 * *best: that run, -1: none. Warns of paths that no result has. False and a sentence where a result or a path cannot be
 * taken, or a file not be written. */
bool table_collect(const Sweep *sweep, const Host *host, int *best, Error *err);
