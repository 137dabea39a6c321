/* mark.h - what files that slender makes say of it, so that it replaces its own and nobody else's.
 *
 * Each kind has a mark of its own, whole and with a version (X.Y.Z), within the first or last bytes. Tables and plotters' files
 * bear none: their readers take nothing else than numbers and strokes. A result has that of safe_file.h. */
#pragma once
#include "base/error.h"
#include <stddef.h>

#define MARK_PNG(version)  "tEXtSoftware\0slender " version
#define MARK_SVG(version)  "<metadata>made by slender " version "</metadata>\n"
#define MARK_PDF(version)  "% made by slender " version "\n"
#define MARK_WEBP(version) "xmp:CreatorTool=\"slender " version "\""
#define MARK_HTML(version) "<meta name=\"generator\" content=\"slender " version "\">"
#define MARK_GLB(version)  "\"generator\":\"slender " version "\""
#define MARK_PLY(version)  "comment made by slender " version ", lengths in metres\n"
#define MARK_OBJ(version)  "# made by slender " version "\n"
#define MARK_STL(version)  "made by slender " version ", lengths in mm"
#define MARK_ZIP(version)  "made by slender " version /* the comment of the archive, .3mf and .npz */

/* A chunk of a PNG, to stand before the last one, which has so many bytes. The caller frees it. */
enum { MARK_PNG_END = 12 };
unsigned char *mark_png_chunk(size_t *size);

/* Is there a file of a kind that bears the mark, and it bears none or cannot be read? An empty one is nobody's. Endings are
 * those of any case. */
bool mark_is_foreign(const char *path);

/* replace_check, and false and a sentence where it is foreign; by force all may be replaced. */
bool mark_check(const char *path, bool force, Error *err);
