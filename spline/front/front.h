/* front.h - what the files of this front have of each other: parts of the drawing's row (body.c). Model.self is a
 * Drawing. */
#pragma once
#include "io/arrays.h"
#include "model/model.h"
#include "spline/front/drawing.h"

/* records.c: into a list for the journal, what stays as it is, and strokes. */
void drawing_add_static(const Drawing *drawing, Arrays *list);
void drawing_add_strokes(const Drawing *drawing, const Strokes *strokes, Arrays *list);

extern const JobRow spline_job_draw; /* job_draw.c */
