/* pattern.h - which entries of a symmetric matrix there are. Private to the sparse layer. */
#pragma once

/* The lower triangle in compressed columns: the diagonal first, rows ascending. */
typedef struct Pattern {
    int n, *start, *rows; /* start[n + 1] */
} Pattern;

/* Groups of unknowns that are coupled, each with each: group g has unknowns[start[g]] .. unknowns[start[g+1] - 1]; one
 * may be there twice, one that is < 0 is none. */
typedef struct Groups {
    int count;
    const long *start; /* [count + 1] */
    const int *unknowns;
} Groups;

/* Of n unknowns in the order given by rank[n] (NULL: as numbered); every diagonal entry is in it. */
Pattern pattern_create(int n, Groups groups, const int *rank);
void pattern_destroy(Pattern *pattern);

/* Where entry (row, column), row >= column, is stored; it must be there. */
int pattern_slot(const Pattern *pattern, int row, int column);

/* The same where it is known to be at `from` or behind: soon, where it is there or the next one. */
int pattern_slot_from(const Pattern *pattern, int row, int column, int from);

/* All entries of both, which are of one size. where[entries of a] (or NULL): where each went. */
Pattern pattern_union(const Pattern *a, const Pattern *b, int *where);

/* The same with unknown i called to[i]. where[entries] (or NULL): where each went. */
Pattern pattern_permute(const Pattern *pattern, const int *to, int *where);
