/* probe_table.h - NAME_probes.csv: the scene's probes as a table for people and their programs. */
#pragma once
#include "io/result.h"
#include "model/model.h"

/* Writes it from a result: its first line are the columns, stage, time or evaluation, of several load cases `case` (from 0, in
 * the scene's order), and NAME, or NAME.x, NAME.y, NAME.z of three numbers; no comments. Without rows it is that line. */
bool probe_table_write(const Model *model, Result *result, const char *path, Error *err);

/* The table itself, of a result alone and the scene that it keeps; the caller frees it. NULL and a sentence where there are no rows
 * of probes, too. */
char *probe_table_text(const Scene *scene, Result *result, Error *err);
