#include "solve/pattern.h"
#include "base/memory.h"
#include <assert.h>
#include <stdlib.h>
#include <string.h>

static int compare_int(const void *a, const void *b)
{
    int i = *(const int *)a, j = *(const int *)b;
    return (i > j) - (i < j);
}

/* For each unknown, the groups that hold it. */
static void list_groups(int n, Groups groups, long **first, int **list)
{
    const long *start = groups.start;
    const int *unknowns = groups.unknowns;
    long *at = mem_alloc((size_t)n + 2, sizeof *at);
    for (long k = 0; k < start[groups.count]; k++)
        if (unknowns[k] >= 0) at[unknowns[k] + 2]++;
    for (int i = 0; i < n; i++) at[i + 2] += at[i + 1];
    *list = mem_alloc((size_t)at[n + 1], sizeof **list);
    for (int g = 0; g < groups.count; g++)
        for (long k = start[g]; k < start[g + 1]; k++)
            if (unknowns[k] >= 0) (*list)[at[unknowns[k] + 1]++] = g;
    *first = at;
}

Pattern pattern_create(int n, Groups groups, const int *rank)
{
    long *first;
    int *list;
    list_groups(n, groups, &first, &list);
    int *unknown = mem_alloc((size_t)n, sizeof *unknown); /* the unknown of each column */
    for (int i = 0; i < n; i++) unknown[rank ? rank[i] : i] = i;

    int *mark = mem_alloc((size_t)n, sizeof *mark);
    for (int i = 0; i < n; i++) mark[i] = -1;
    Pattern pattern = {n, mem_alloc((size_t)n + 1, sizeof(int)), NULL};
    long room = 16L * n + 16, count = 0;
    pattern.rows = mem_alloc((size_t)room, sizeof(int));
    for (int column = 0; column < n; column++) {
        int i = unknown[column];
        mark[column] = column;
        if (count + n >= room) {
            pattern.rows = mem_resize(pattern.rows, (size_t)count, (size_t)(2 * room + n), sizeof(int));
            room = 2 * room + n;
        }
        pattern.rows[count++] = column;
        for (long k = first[i]; k < first[i + 1]; k++)
            for (long m = groups.start[list[k]]; m < groups.start[list[k] + 1]; m++) {
                if (groups.unknowns[m] < 0) continue;
                int row = rank ? rank[groups.unknowns[m]] : groups.unknowns[m];
                if (row > column && mark[row] != column) mark[row] = column, pattern.rows[count++] = row;
            }
        qsort(pattern.rows + pattern.start[column], (size_t)(count - pattern.start[column]), sizeof(int),
              compare_int);
        pattern.start[column + 1] = (int)count;
    }
    mem_free(first);
    mem_free(list);
    mem_free(unknown);
    mem_free(mark);
    return pattern;
}

void pattern_destroy(Pattern *pattern)
{
    mem_free(pattern->start);
    mem_free(pattern->rows);
    *pattern = (Pattern){0};
}

int pattern_slot(const Pattern *pattern, int row, int column)
{
    return pattern_slot_from(pattern, row, column, pattern->start[column]);
}

int pattern_slot_from(const Pattern *pattern, int row, int column, int from)
{
    const int *rows = pattern->rows;
    int low = from, high = pattern->start[column + 1] - 1;
    if (rows[low] == row) return low;
    if (low < high && rows[low + 1] == row) return low + 1;
    while (low < high) {
        int middle = (low + high) / 2;
        if (rows[middle] < row)
            low = middle + 1;
        else
            high = middle;
    }
    assert(rows[low] == row);
    return low;
}

static Pattern pattern_alloc(int n, size_t entries)
{
    return (Pattern){n, mem_alloc((size_t)n + 1, sizeof(int)), mem_alloc(entries, sizeof(int))};
}

Pattern pattern_union(const Pattern *a, const Pattern *b, int *where)
{
    int n = a->n, count = 0;
    Pattern all = pattern_alloc(n, (size_t)a->start[n] + (size_t)b->start[n]);
    for (int column = 0; column < n; column++) {
        int i = a->start[column], j = b->start[column], i_end = a->start[column + 1],
            j_end = b->start[column + 1];
        while (i < i_end || j < j_end) {
            int row = j == j_end || (i < i_end && a->rows[i] < b->rows[j]) ? a->rows[i] : b->rows[j];
            if (j < j_end && b->rows[j] == row) j++;
            if (i < i_end && a->rows[i] == row) {
                if (where) where[i] = count;
                i++;
            }
            all.rows[count++] = row;
        }
        all.start[column + 1] = count;
    }
    return all;
}

/* Sorted by counting: first by row, then, row after row, by column. */
Pattern pattern_permute(const Pattern *pattern, const int *to, int *where)
{
    typedef struct Moved {
        int column, from;
    } Moved;
    int n = pattern->n, count = pattern->start[n];
    Pattern moved = pattern_alloc(n, (size_t)count);
    int *row_end = mem_alloc((size_t)n + 2, sizeof *row_end),
        *column_end = mem_alloc((size_t)n + 2, sizeof(int));
    Moved *by_row = mem_alloc((size_t)count, sizeof *by_row);
    for (int pass = 0; pass < 2; pass++) {
        for (int column = 0; column < n; column++)
            for (int k = pattern->start[column]; k < pattern->start[column + 1]; k++) {
                int a = to[pattern->rows[k]], b = to[column], row = a > b ? a : b, other = a > b ? b : a;
                if (pass == 0)
                    row_end[row + 2]++, column_end[other + 2]++;
                else
                    by_row[row_end[row + 1]++] = (Moved){other, k};
            }
        for (int i = 0; pass == 0 && i < n; i++)
            row_end[i + 2] += row_end[i + 1], column_end[i + 2] += column_end[i + 1];
    }
    for (int row = 0; row < n; row++)
        for (int k = row_end[row]; k < row_end[row + 1]; k++) {
            int slot = column_end[by_row[k].column + 1]++;
            moved.rows[slot] = row;
            if (where) where[by_row[k].from] = slot;
        }
    memcpy(moved.start, column_end, ((size_t)n + 1) * sizeof *moved.start);
    mem_free(row_end);
    mem_free(column_end);
    mem_free(by_row);
    return moved;
}
