/* show_framings.h - charts of the natural strains of one curve in several frames, one above the other. */
#pragma once
#include "view/chart.h"
#include "view/show_data.h"

enum { FRAMING_CHARTS = 3 };

/* A chart for each strain, in which each framing is a series: charts[FRAMING_CHARTS]. strands[strand_count + 1]: the first node of
 * each framing; s[nodes], strain[nodes][3]. Returns how many: 0 where the result's strands are no framings. */
int show_framings(ShowData *data, int strand_count, const int *strands, const double *s, const double *strain,
                  Chart *charts);
