#include "sweep/runs_file.h"
#include "base/memory.h"
#include "io/scan.h"
#include "sweep/sweep.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Cuts the cell at *at off, without blanks and quotes around it; false where its quote has no end. *more: another one
 * follows. */
static bool next_cell(char **at, char mark, char **cell, bool *more)
{
    char *from = *at + strspn(*at, " \t"), *to = from;
    *cell = from;
    if (*from != '"') {
        char *end = from + strcspn(from, (char[]){mark, 0});
        *more = *end != 0;
        *at = end + *more;
        while (end > from && strchr(" \t", end[-1])) end--;
        *end = 0;
        return true;
    }
    for (from++; *from && (*from != '"' || from[1] == '"'); from++) {
        from += *from == '"';
        *to++ = *from;
    }
    if (*from != '"') return false;
    from += 1 + strspn(from + 1, " \t");
    *to = 0;
    *more = *from == mark;
    *at = from + *more;
    return *more || !*from;
}

static void add_cell(RunsFile *list, const char *cell)
{
    list->cells = mem_resize(list->cells, list->cell_count, list->cell_count + 1, sizeof *list->cells);
    list->cells[list->cell_count++] = mem_text(cell);
}

/* A key of the first line that is there before, too; NULL: there is none. */
static const char *find_twin(const RunsFile *list)
{
    for (int k = 1; k < list->columns; k++)
        for (int i = 0; i < k; i++)
            if (!strcmp(list->cells[i], list->cells[k])) return list->cells[k];
    return NULL;
}

/* The line's cells behind those that there are; the first line says how many. */
static bool take_line(RunsFile *list, char *text, char mark, int line, const char *path, Error *err)
{
    int count = 0;
    for (bool more = true; more;) {
        char *cell;
        if (!next_cell(&text, mark, &cell, &more))
            return error_set(err, "%s:%d: a quote without an end, or something behind it", path, line);
        if (!*cell) return error_set(err, "%s:%d: cell %d is empty", path, line, count + 1);
        add_cell(list, cell);
        count++;
    }
    bool first = list->columns == 0;
    if (first) list->columns = count;
    if (count != list->columns)
        return error_set(err, "%s:%d: %d cells, and the first line names %d keys", path, line, count,
                         list->columns);
    const char *twin = first ? find_twin(list) : NULL;
    if (twin) return error_set(err, "%s:%d: the key '%s' is there twice", path, line, twin);
    if (!first) list->rows++;
    list->line = mem_resize(list->line, (size_t)list->rows, (size_t)list->rows + 1, sizeof *list->line);
    list->line[list->rows] = line;
    return true;
}

/* What stands behind the mark that spreadsheets put before a text in UTF-8, of the file's first line. */
static bool skip_mark(const char *path, char **text, size_t length, Error *err)
{
    const char *behind = *text;
    bool ok = scan_skip_mark(path, &behind, &length, err);
    *text += behind - *text;
    return ok;
}

bool runs_file_read(const char *path, RunsFile *list, Error *err)
{
    *list = (RunsFile){0};
    FILE *file = fopen(path, "r");
    if (!file) return error_set(err, "%s: cannot be read: %s", path, strerror(errno));
    char *text = NULL, mark = ',';
    size_t room = 0;
    bool ok = true;
    ssize_t length;
    for (int line = 1; ok && (length = getline(&text, &room, file)) >= 0; line++) {
        char *begin = text;
        if (line == 1 && !(ok = skip_mark(path, &begin, (size_t)length, err))) break;
        begin[strcspn(begin, "\r\n")] = 0;
        begin += strspn(begin, " \t");
        if (!*begin || *begin == '#') continue;
        if (!list->columns && strchr(begin, ';')) mark = ';';
        ok = take_line(list, begin, mark, line, path, err);
        if (ok && list->rows > SWEEP_RUNS_MAX)
            ok = error_set(err, "%s: more than %d runs", path, SWEEP_RUNS_MAX);
    }
    free(text);
    fclose(file);
    return ok && (list->rows || error_set(err,
                                          "%s: there are no runs: its first line names keys, each "
                                          "further one is a run's values",
                                          path));
}

void runs_file_clear(RunsFile *list)
{
    for (size_t i = 0; i < list->cell_count; i++) mem_free(list->cells[i]);
    mem_free(list->cells);
    mem_free(list->line);
    *list = (RunsFile){0};
}
