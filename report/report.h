/* report.h - results as one page of HTML that needs nothing else: no server, no library, no net.
 *
 * The page (page/) is a viewer; what it shows is a document of JSON and one block of bytes (document.h): bodies, targets,
 * obstacles and curves over the frames, drawings, charts, facts and the scenes' texts. The same results make the same bytes. */
#pragma once
#include "base/error.h"
#include "view/show.h"

typedef struct ReportDef {
    int frames; /* of each result, evenly spread, the first and the last among them; 0: as many as some 10 MB hold */
} ReportDef;

/* Writes the page of one result, or of several beside each other. SHOW_HAS_NOT with a sentence where one of them cannot be
 * read or has nothing to show, SHOW_CANNOT_WRITE with one where the file cannot be written: it is then as it was. */
ShowStatus report_write(const char *const *results, int count, const char *path, const ReportDef *def,
                        Error *err);
