/* mark.h - what files that slender makes say of it, so that it replaces its own and nobody else's.
 *
 * "slender 1.2.3" stands within the first or last bytes of a .png (as tEXt), .svg, .pdf, .webp (as
 * XMP), .html, .glb, .ply, .obj, .stl, .3mf and .npz. Tables and plotters' files bear no mark: their readers take nothing else
 * than numbers and strokes. A result has its own, of safe_file.h. */
#pragma once
#include "base/error.h"
#include <stddef.h>

#define MARK_TEXT "slender " SLENDER_VERSION

/* A chunk of a PNG, to stand before the last one, which has so many bytes. The caller frees it. */
enum { MARK_PNG_END = 12 };
unsigned char *mark_png_chunk(size_t *size);

/* replace_check, and false and a sentence where there is a file of a kind that bears the mark, and it bears none; an empty one is nobody's. By
 * force all may be replaced. */
bool mark_check(const char *path, bool force, Error *err);
