/* xdmf.h - the sidecar that shows the steps of a result to ParaView 5.11. Private to result.c. */
#pragma once
#include "io/result_vtk.h"

/* The file's text, the caller's, for the result file at a path that holds these frames; NULL and a sentence
 * where the journal cannot be read. */
char *xdmf_text(const char *result, const VtkFrames *frames, Error *err);

/* Can its readers find a file of that name? */
bool xdmf_can_name(const char *result);
