#include "model/rows.h"
#include "model/scene_tables.h"
#include <pthread.h>
#include <stdio.h>
#include <string.h>

enum { JOBS_MAX = 24, KEYS_MAX = 48, WHEN_MAX = 400, DOC_MAX = 200 };

const char *scene_job_names[JOBS_MAX + 1];

static pthread_once_t made = PTHREAD_ONCE_INIT;
static YamlField keys[KEYS_MAX];
static char conditions[KEYS_MAX][WHEN_MAX], docs[BODIES_MAX][DOC_MAX];
static YamlTable table;

/* ---- The table ---- */

static void add_job(const char *name)
{
    int count = 0;
    while (scene_job_names[count] && strcmp(scene_job_names[count], name)) count++;
    scene_job_names[count] = name;
}

/* A row with what the bodies say of its key. */
static void put_uses(YamlField *row, char *condition)
{
    snprintf(condition, WHEN_MAX, "%s", row->when ? row->when : "");
    for (int k = 0; bodies[k]; k++)
        for (const KeyUse *use = bodies[k]->uses; use->key; use++) {
            size_t length = strlen(condition);
            if (strcmp(use->key, row->key)) continue;
            snprintf(condition + length, WHEN_MAX - length, "%s%s", length ? " & " : "", use->when);
        }
    if (*condition) row->when = condition;
}

/* What a body's key is, with its jobs: "the body: a shell, with `job: equilibrium, design`". */
static const char *say_jobs(const BodyRow *body, char *doc)
{
    snprintf(doc, DOC_MAX, "%s, with `job:", body->doc);
    for (const JobRow *const *job = body->jobs; *job; job++) {
        size_t length = strlen(doc);
        snprintf(doc + length, DOC_MAX - length, "%s %s%s", job == body->jobs ? "" : ",", (*job)->name,
                 job[1] ? "" : "`");
    }
    return doc;
}

static void make_table(void)
{
    int count = 0;
    for (int k = 0; bodies[k]; k++)
        for (const JobRow *const *job = bodies[k]->jobs; *job; job++) add_job((*job)->name);
    keys[count++] = scene_form.fields[0];
    for (int k = 0; bodies[k]; k++)
        keys[count++] = (YamlField){.key = bodies[k]->key,
                                    .kind = FIELD_OPTIONAL,
                                    .offset = offsetof(Scene, body) + (size_t)k * sizeof(void *),
                                    .size = bodies[k]->table->size,
                                    .table = bodies[k]->table,
                                    .one_of = 1,
                                    .required = true,
                                    .doc = say_jobs(bodies[k], docs[k])};
    for (const YamlField *row = scene_form.fields + 1; row->key; row++, count++) {
        keys[count] = *row;
        put_uses(&keys[count], conditions[count]);
    }
    table = scene_form;
    table.fields = keys;
}

const YamlTable *scene_table(void)
{
    pthread_once(&made, make_table);
    return &table;
}

/* ---- Rows ---- */

const BodyRow *scene_body(const Scene *scene)
{
    int k = 0;
    while (!scene->body[k]) k++;
    return bodies[k];
}

const JobRow *scene_job(const Scene *scene)
{
    return body_job(scene_body(scene), scene_job_names[scene->job]);
}

const JobRow *body_job(const BodyRow *body, const char *name)
{
    for (const JobRow *const *job = body->jobs; *job; job++)
        if (!strcmp((*job)->name, name)) return *job;
    return NULL;
}

const void *scene_of(const Scene *scene, const BodyRow *row)
{
    for (int k = 0; bodies[k]; k++)
        if (bodies[k] == row) return scene->body[k];
    return NULL;
}
