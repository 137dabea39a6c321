#include "base/workers.h"
#include "base/memory.h"
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>

struct Workers {
    int count; /* with the calling thread */
    pthread_t *threads;
    pthread_mutex_t lock;
    pthread_cond_t begin, end;
    atomic_long run; /* number of the run at hand                       */
    atomic_int busy; /* threads that are at it, but for the calling one */
    bool open;       /* it may be joined                                */
    bool finished;   /* for good                                        */
    void (*task)(void *self, int k);
    void *self;
    int tasks;
    atomic_int next;
};

/* Runs follow each other within microseconds, in which a sleeping thread would hardly wake: so each looks out
 * for a while, about a tenth of a millisecond. */
enum { PATIENCE = 2000 };

static void breathe(void)
{
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#endif
}

static void do_tasks(Workers *workers)
{
    for (int k; (k = atomic_fetch_add(&workers->next, 1)) < workers->tasks;) workers->task(workers->self, k);
}

/* Takes part in the run at hand, if that is still to be had. */
static void join_run(Workers *workers)
{
    if (!workers->open) return;
    workers->busy++;
    pthread_mutex_unlock(&workers->lock);
    do_tasks(workers);
    pthread_mutex_lock(&workers->lock);
    if (--workers->busy == 0) pthread_cond_signal(&workers->end);
}

static void *work(void *data)
{
    Workers *workers = data;
    pthread_mutex_lock(&workers->lock);
    for (long done = 0; !workers->finished; done = workers->run) {
        join_run(workers);
        pthread_mutex_unlock(&workers->lock);
        for (int k = 0; k < PATIENCE && atomic_load_explicit(&workers->run, memory_order_relaxed) == done;
             k++)
            breathe();
        pthread_mutex_lock(&workers->lock);
        while (workers->run == done && !workers->finished) pthread_cond_wait(&workers->begin, &workers->lock);
    }
    pthread_mutex_unlock(&workers->lock);
    return NULL;
}

Workers *workers_create(int threads)
{
    Workers *workers = mem_alloc(1, sizeof *workers);
    workers->count = 1;
    pthread_mutex_init(&workers->lock, NULL);
    pthread_cond_init(&workers->begin, NULL);
    pthread_cond_init(&workers->end, NULL);
    workers->threads = mem_alloc(threads > 1 ? (size_t)threads - 1 : 0, sizeof *workers->threads);
    while (workers->count < threads &&
           pthread_create(&workers->threads[workers->count - 1], NULL, work, workers) == 0)
        workers->count++;
    return workers;
}

void workers_destroy(Workers *workers)
{
    if (!workers) return;
    pthread_mutex_lock(&workers->lock);
    workers->finished = true;
    pthread_cond_broadcast(&workers->begin);
    pthread_mutex_unlock(&workers->lock);
    for (int t = 0; t < workers->count - 1; t++) pthread_join(workers->threads[t], NULL);
    pthread_cond_destroy(&workers->begin);
    pthread_cond_destroy(&workers->end);
    pthread_mutex_destroy(&workers->lock);
    mem_free(workers->threads);
    mem_free(workers);
}

int workers_count(const Workers *workers)
{
    return workers ? workers->count : 1;
}

void workers_run(Workers *workers, int tasks, void (*task)(void *self, int k), void *self)
{
    if (workers_count(workers) == 1 || tasks < 2) {
        for (int k = 0; k < tasks; k++) task(self, k);
        return;
    }
    pthread_mutex_lock(&workers->lock);
    workers->task = task;
    workers->self = self;
    workers->tasks = tasks;
    workers->open = true;
    workers->run++;
    atomic_store(&workers->next, 0);
    pthread_cond_broadcast(&workers->begin);
    pthread_mutex_unlock(&workers->lock);
    do_tasks(workers);
    pthread_mutex_lock(&workers->lock);
    workers->open = false; /* who has not come yet is not waited for: on a busy machine threads wake late */
    pthread_mutex_unlock(&workers->lock);
    for (int k = 0; k < PATIENCE && atomic_load_explicit(&workers->busy, memory_order_relaxed) > 0; k++)
        breathe();
    pthread_mutex_lock(&workers->lock);
    while (workers->busy > 0) pthread_cond_wait(&workers->end, &workers->lock);
    pthread_mutex_unlock(&workers->lock);
}
