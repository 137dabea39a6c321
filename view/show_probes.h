/* show_probes.h - charts of a result's probes (docs/result.md) over stages, time or evaluations. */
#pragma once
#include "view/chart.h"
#include "view/show_data.h"

/* One for each unit, of the three numbers that change most; at most `room`, and none of a single row. What they borrow is kept in the data. */
int show_probes_charts(ShowData *data, Chart *charts, int room);
