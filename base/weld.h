/* weld.h - which points lie on one another. */
#pragma once

/* first[v] = the lowest-numbered point u <= v with first[u] = u that lies within distance of v (0: at exactly
 * the same coordinates); first[v] = v where there is none. points[count][3] are finite. Linear time, by a
 * hashed grid. */
void weld_map(const double (*points)[3], int count, double distance, int *first);
