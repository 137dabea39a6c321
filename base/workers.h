/* workers.h - a few threads that share out numbered tasks.
 *
 * Which thread does which task is left to chance. So each task writes to places of its own, and what is
 * summed over tasks is summed afterwards in a fixed order: then results do not depend on the number of
 * threads.
 *
 * A task that runs out of memory is left, and no other is begun; when nobody works any more, the hook of the thread that
 * called workers_run is called (base/memory.h). The Workers are as good as before. In a child of fork the calling thread does all. */
#pragma once

typedef struct Workers Workers;

/* threads - 1 new threads; the calling one is the first. Threads that cannot be had are done without. */
Workers *workers_create(int threads);
void workers_destroy(Workers *workers);

/* How many share the work; 1 for NULL. */
int workers_count(const Workers *workers);

/* Does task(self, k) for all k in [0, tasks) and returns when all are done. NULL: in this thread, in order.
 * One run at a time. */
void workers_run(Workers *workers, int tasks, void (*task)(void *self, int k), void *self);
