#include "base/workers.h"
#include "base/guard.h"
#include "base/memory.h"
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <unistd.h>

/* A run is open while tasks may be left in it. Who comes to an open run is counted in and out; the calling thread closes
 * it when no task is left, and waits for those that are in, not for those that never came: on a busy machine a thread
 * may get its turn milliseconds later. */
struct Workers {
    int count;     /* with the calling thread */
    pid_t process; /* whose threads they are  */
    pthread_t *threads;
    pthread_mutex_t lock; /* of going to sleep */
    pthread_cond_t begin, end;
    atomic_llong state;  /* number of the run, whether it is open, and how many are in */
    atomic_int sleeping; /* threads that wait for `begin`, and the calling one for `end` */
    bool finished;       /* for good; behind the lock */
    void (*task)(void *self, int k);
    void *self;
    int tasks;
    atomic_int next;
    atomic_bool failed; /* a task of this run has */
    Error failure;      /* of the first one       */
};

enum { INSIDE = 0xffff, OPEN = 0x10000, RUN = 0x20000 }; /* of the state */

/* Runs follow each other within microseconds, in which a sleeping thread would hardly wake: so each looks out so many
 * times before it sleeps, but leaves its processor to whom has use for it in between. */
enum { PATIENCE = 200 };

/* Bytes of a thread's stack, whatever the limit of the caller's: packs of elements lie there. */
enum { STACK = 2 << 20 };

static void do_tasks(void *self)
{
    Workers *workers = self;
    for (int k; (k = atomic_fetch_add_explicit(&workers->next, 1, memory_order_relaxed)) < workers->tasks;)
        workers->task(workers->self, k);
}

/* Those that are left after one that failed are done no more. The error is the thread's own, for each of its runs. */
static void share_tasks(Workers *workers, Error *err)
{
    if (guard_call(do_tasks, workers, err)) return;
    if (!atomic_exchange(&workers->failed, true)) workers->failure = *err;
    atomic_store_explicit(&workers->next, workers->tasks, memory_order_relaxed);
}

/* Counted into the run that is open, if it is not that one. */
static bool enter(Workers *workers, long long *done)
{
    long long state = atomic_load(&workers->state);
    while (state & OPEN && state / RUN != *done)
        if (atomic_compare_exchange_weak(&workers->state, &state, state + 1)) {
            *done = state / RUN;
            return true;
        }
    return false;
}

/* Counted out; the last one wakes the calling thread where that sleeps. */
static void leave(Workers *workers)
{
    long long state = atomic_fetch_sub(&workers->state, 1) - 1;
    if (state & (OPEN | INSIDE) || atomic_load(&workers->sleeping) == 0) return;
    pthread_mutex_lock(&workers->lock);
    pthread_cond_signal(&workers->end);
    pthread_mutex_unlock(&workers->lock);
}

/* False where there will be no more run. */
static bool wait_for_run(Workers *workers, long long *done)
{
    for (int k = 0; k < PATIENCE; k++, sched_yield())
        if (enter(workers, done)) return true;
    bool entered = false;
    pthread_mutex_lock(&workers->lock);
    atomic_fetch_add(&workers->sleeping, 1);
    while (!workers->finished && !(entered = enter(workers, done)))
        pthread_cond_wait(&workers->begin, &workers->lock);
    atomic_fetch_sub(&workers->sleeping, 1);
    pthread_mutex_unlock(&workers->lock);
    return entered;
}

static void *work(void *data)
{
    Workers *workers = data;
    Error err;
    for (long long done = 0; wait_for_run(workers, &done); leave(workers)) share_tasks(workers, &err);
    return NULL;
}

static void wake(Workers *workers)
{
    if (atomic_load(&workers->sleeping) == 0) return;
    pthread_mutex_lock(&workers->lock);
    pthread_cond_broadcast(&workers->begin);
    pthread_mutex_unlock(&workers->lock);
}

static bool is_empty(Workers *workers)
{
    return (atomic_load(&workers->state) & INSIDE) == 0;
}

static void wait_for_last(Workers *workers)
{
    for (int k = 0; k < PATIENCE; k++, sched_yield())
        if (is_empty(workers)) return;
    pthread_mutex_lock(&workers->lock);
    atomic_fetch_add(&workers->sleeping, 1);
    while (!is_empty(workers)) pthread_cond_wait(&workers->end, &workers->lock);
    atomic_fetch_sub(&workers->sleeping, 1);
    pthread_mutex_unlock(&workers->lock);
}

Workers *workers_create(int threads)
{
    Workers *workers = mem_alloc(1, sizeof *workers);
    workers->count = 1;
    workers->process = getpid();
    pthread_mutex_init(&workers->lock, NULL);
    pthread_cond_init(&workers->begin, NULL);
    pthread_cond_init(&workers->end, NULL);
    workers->threads = mem_alloc(threads > 1 ? (size_t)threads - 1 : 0, sizeof *workers->threads);
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, STACK);
    while (workers->count < threads &&
           pthread_create(&workers->threads[workers->count - 1], &attributes, work, workers) == 0)
        workers->count++;
    pthread_attr_destroy(&attributes);
    return workers;
}

/* Not in a child of fork, where there are none, nor anybody who could leave the lock. */
static void end_threads(Workers *workers)
{
    pthread_mutex_lock(&workers->lock);
    workers->finished = true;
    pthread_cond_broadcast(&workers->begin);
    pthread_mutex_unlock(&workers->lock);
    for (int t = 0; t < workers->count - 1; t++) pthread_join(workers->threads[t], NULL);
    pthread_cond_destroy(&workers->begin);
    pthread_cond_destroy(&workers->end);
    pthread_mutex_destroy(&workers->lock);
}

void workers_destroy(Workers *workers)
{
    if (!workers) return;
    if (workers->process == getpid()) end_threads(workers);
    mem_free(workers->threads);
    mem_free(workers);
}

int workers_count(const Workers *workers)
{
    return workers && workers->process == getpid() ? workers->count : 1;
}

/* Nobody is in the run any more. */
static _Noreturn void fail(Workers *workers)
{
    atomic_store(&workers->failed, false);
    mem_exhausted_again(workers->failure.text);
}

void workers_run(Workers *workers, int tasks, void (*task)(void *self, int k), void *self)
{
    if (workers_count(workers) == 1 || tasks < 2) {
        for (int k = 0; k < tasks; k++) task(self, k);
        return;
    }
    workers->task = task;
    workers->self = self;
    workers->tasks = tasks;
    atomic_store_explicit(&workers->next, 0, memory_order_relaxed);
    atomic_fetch_add(&workers->state, RUN + OPEN);
    wake(workers);
    Error err;
    share_tasks(workers, &err);
    if ((atomic_fetch_sub(&workers->state, OPEN) & INSIDE) > 0) wait_for_last(workers);
    if (atomic_load(&workers->failed)) fail(workers);
}
