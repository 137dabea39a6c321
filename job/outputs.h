/* outputs.h - files beside a result: the table of its probes, and of a drawing those that the scene's key `output` names, relative
 * to the result's folder. */
#pragma once
#include "job/run.h"

/* Can they be written, the picture if it is wanted, and is nothing lost by it: each a file of its own, none
 * of them the scene of that path (NULL: of none) or a file that it names? Refused before the work, not after it. */
bool outputs_check(const Scene *scene, const char *path, const char *result, bool picture, Error *err);

/* Are the folders there, of all but the picture? Touches nothing: the run may live. */
bool outputs_check_folders(const Scene *scene, const char *result, Error *err);

/* Of a result that is not there yet: false and a sentence where one of them is, or a drawing of an iteration: it is
 * somebody else's. */
bool outputs_check_new(const Scene *scene, const char *result, bool picture, Error *err);

/* Are those that are there slender's own, or of kinds that bear no mark (mark.h)? False and a sentence else; of a run that
 * is resumed it is another one, since --force would discard it. */
bool outputs_check_marks(const Scene *scene, const char *result, bool picture, bool resumed, Error *err);

/* Removes what the run that left the result has put beside it by its name: the table of probes and drawings, but for files
 * that the scene, which takes its place, is made of. Pictures stay, and files that a scene named. */
void outputs_remove_old(const Scene *scene, const char *result);

/* False and a sentence where what is to be written is the input (NULL: there is none), or one of the files that the scene names
 * (NULL: none). */
bool outputs_check_source(const Scene *scene, const char *input, const char *output, Error *err);

/* Writes them from the result; false and a sentence where one cannot be. Of other scenes there are none. */
bool outputs_write(Run *run, Error *err);

/* Where the picture goes; the caller frees. */
char *outputs_picture(const Scene *scene, const char *result);
