/* report_private.h - what the parts of a report share: each adds itself to the object of its result in the document. */
#pragma once
#include "report/document.h"
#include "report/report.h"
#include "view/show_cases.h"
#include "view/show_data.h"
#include "view/show_obstacles.h"

typedef struct ReportPart {
    Document *document;
    ShowData *data;
    ShowDef *show; /* the data's, whose field may be set */
    int most;      /* frames that are shown; 0: as many as there is room for */
    int frame_count;
    const int *frames; /* [frame_count] which of the result's are shown */
    bool timed;        /* they are moments */
    ShowWay way;       /* of their points */
    double origin[3];  /* m, its middle: places in the page are from there, however far away that is */
    ShowCases cases;
} ReportPart;

/* A mesh: its frames with the numbers on its faces, targets, how it is magnetised. Adds nothing where there is none. */
bool report_body(const ReportPart *part, Error *err);

/* Strands of rods, and of motions the curves and places that were to be followed. */
bool report_curves(const ReportPart *part, Error *err);

/* Obstacles, magnets and coils, and where they are; where rods are held; field and gravity. */
bool report_surroundings(const ReportPart *part, Error *err);

/* Arrows of a flux density that varies in space, or why there are none. */
void report_flux(const ReportPart *part);

/* [frame] what it is called as a stage of a sequence: "stage 3: 20 mT, t = 2 s". */
const char *const *report_stages(const ReportPart *part);

/* Within the object of the frames: of a design which evaluation each is, counted from 0. */
void report_evaluations(const ReportPart *part);

/* A drawing: its strokes as they are plotted, its pens, what was to be drawn. */
bool report_drawing(const ReportPart *part, Error *err);

/* Charts of probes, of motions and of designs. */
bool report_charts(const ReportPart *part, Error *err);

/* Every single number of the result, and the scene's text. */
bool report_facts(const ReportPart *part, Error *err);

/* "#d55e00" */
void report_color(Document *document, const char *key, Color color);

/* Places, shape.rows x shape.width / 3, from the origin. */
void report_places(const ReportPart *part, const char *key, const double *places, Packed shape);

/* "of": [row of each frame's case], row[case]: which target of a list a case has, -1: none. */
void report_rows(const ReportPart *part, const int *row);

/* Are rows[count][width] all alike? One is then kept. */
bool report_is_static(const double *rows, size_t count, size_t width);
