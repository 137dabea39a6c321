/* show_cases.h - of a result's load cases, what their pictures show. */
#pragma once
#include "view/marks.h"
#include "view/show_data.h"

/* In the scene's order: all of them, or the one asked for. None of a result without cases. */
typedef struct ShowCases {
    int count;
    const char *const *names;
} ShowCases;

/* Kept in the data. False and a sentence where the one asked for is not there. */
bool show_cases(ShowData *data, ShowCases *cases, Error *err);

/* The last frames of a result are those of its cases, if there are several and it is no motion: such a frame's name is its
 * case's, of others show_frame_name. */
const char *show_cases_frame(ShowData *data, const ShowCases *cases, int frame);

/* cases/NAME/what, of so many float64; NULL: it is not there. */
void *show_case_dataset(ShowData *data, const char *name, const char *what, size_t count);

/* Where the case's points x[count][3] should be, NULL where they should be nowhere: coordinates that do not count are those
 * of the points, rows of points without a place NaN. */
const double (*show_case_target(ShowData *data, const char *name, const double (*x)[3], int count))[3];

/* The points of the case's clouds, and how many they are, their missing coordinates those of the middle of its points; NULL:
 * it has none. */
const double (*show_case_cloud_points(ShowData *data, const char *name, const double (*x)[3], int count,
                                      int *points))[3];

/* The points of the case's clouds as dots, how many: those seen in a plane at the body's middle across it. */
int show_case_cloud(ShowData *data, const char *name, const double (*x)[3], int count, Color ink,
                    const MarkDot **dots);
