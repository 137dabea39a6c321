/* recall.h - the frames of a finished run, back from its result into its journal.
 *
 * When the result of a simulation is safe, its frames leave the journal. A run that is then extended needs
 * them again to write a longer result. In single precision they come back as the result has them: written
 * again they are the same.
 *
 * Which result that is the journal knows by its check sum (kind "result"): another run's, or an older one of
 * the same run, is refused. */
#pragma once
#include "base/error.h"
#include "io/journal.h"
#include <stdint.h>

/* Before frames go: the result of that sum has them. */
bool recall_keep(Journal *journal, uint32_t sum, Error *err);

/* Where the result has more frames than the journal. `exact`: they are needed as they were computed. False
 * with a sentence where it cannot be read, has them in single precision only, or is not the one that the
 * frames went to. */
bool recall_frames(Journal *journal, const char *result, bool exact, Error *err);
