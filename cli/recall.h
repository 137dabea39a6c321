/* recall.h - the frames of a finished run, back from its result into its journal.
 *
 * When the result of a simulation is safe, its frames leave the journal. A run that is then extended needs
 * them again to write a longer result. In single precision they come back as the result has them: written
 * again they are the same. */
#pragma once
#include "base/error.h"
#include "io/journal.h"

/* Where the result has more frames than the journal. False with a sentence where it cannot be read. */
bool recall_frames(Journal *journal, const char *result, Error *err);
