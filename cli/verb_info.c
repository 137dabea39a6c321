/* slender info: what is in a result, or in the journal of a running job. */
#include "base/memory.h"
#include "cli/say.h"
#include "cli/verb.h"
#include "io/path.h"
#include "io/result.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* "4 x 3 m" */
static char *shape_text(const Array *array, const char *unit)
{
    char *shape = mem_text("");
    for (int r = 0; r < array->rank; r++) {
        char *longer = mem_format("%s%s%d", shape, r ? " x " : "", array->dims[r]);
        mem_free(shape);
        shape = longer;
    }
    return mem_join(shape, " ", unit);
}

static void print_array(const char *path, const Array *array)
{
    static const char *const types[] = {"real", "integer",
                                        "text"}; /* of whatever length they are in the file */
    const char *unit = array->unit ? array->unit : "";
    char *what;
    if (array->type == ARRAY_TEXT)
        what = strchr(array->data, '\n') ? mem_format("%d bytes", array->dims[0]) : mem_text(array->data);
    else if (array->rank == 0)
        what = array->type == ARRAY_FLOAT64 ? mem_format("%.9g %s", *(const double *)array->data, unit)
                                            : mem_format("%d %s", *(const int *)array->data, unit);
    else
        what = shape_text(array, unit);
    say(stdout, "  %-44s %-8s %s", path, types[array->type], what);
    mem_free(what);
}

static const char *plural(int count)
{
    return count == 1 ? "" : "s";
}

/* "a.vtkhdf: settled, 1 frame" */
static void print_title(Result *result, const char *path)
{
    Array status = {0};
    bool known = result_read(result, "slender/status", &status, NULL);
    int frames = result_step_count(result);
    say(stdout, "%s: %s%s%d frame%s", path, known ? (const char *)status.data : "", known ? ", " : "", frames,
        plural(frames));
    array_clear(&status);
    Array kernels = {0};
    if (result_read(result, "slender/kernels", &kernels, NULL))
        say(stdout, "  OpenBLAS's kernels: %s", (const char *)kernels.data);
    array_clear(&kernels);
}

static int info_result(const char *path)
{
    Error err;
    char **paths;
    int count;
    Result *result = result_open(path, &err);
    if (!result || !result_list(result, &paths, &count, &err)) {
        if (result) error_prefix(&err, "%s", path);
        result_close(result);
        return verb_fail(RUN_REFUSED, err.text);
    }
    print_title(result, path);
    for (int k = 0; k < count; k++) {
        Array array;
        if (!result_read(result, paths[k], &array, &err)) {
            say(stdout, "  %-44s %s", paths[k], err.text);
            continue;
        }
        print_array(paths[k], &array);
        array_clear(&array);
    }
    mem_free(paths);
    result_close(result);
    return RUN_DONE;
}

static double evaluation_number(Journal *journal, int index, const char *name)
{
    Array array;
    if (!journal_get(journal, "evaluation", index, name, &array, NULL)) return NAN;
    double value =
        array_count(&array) == 1 && array.type == ARRAY_FLOAT64 ? *(const double *)array.data : NAN;
    array_clear(&array);
    return value;
}

static void print_design(Journal *journal, int index)
{
    printf("  objective %.6e  gradient %.3e  %.1f s\n", evaluation_number(journal, index, "objective"),
           evaluation_number(journal, index, "gradient_norm"), evaluation_number(journal, index, "seconds"));
}

static void print_drawing(Journal *journal, int index)
{
    printf("  energy %.6e  %g strokes  %.1f s\n", evaluation_number(journal, index, "energy"),
           evaluation_number(journal, index, "strokes"), evaluation_number(journal, index, "seconds"));
}

/* Where it is known: a preview's steps have no iterations. */
static void print_count(Journal *journal, int index, const char *name, const char *noun)
{
    double count = evaluation_number(journal, index, name);
    if (!isnan(count)) printf("  %g %s%s", count, noun, count == 1 ? "" : "s");
}

static void print_step(Journal *journal, int index)
{
    printf("  t %.6g s", evaluation_number(journal, index, "time"));
    print_count(journal, index, "newton_iterations", "Newton iteration");
    print_count(journal, index, "factorizations", "factorization");
    printf("\n");
}

/* What "evaluations" of a journal are, by what they hold. */
typedef struct EvaluationKind {
    const char *has; /* NULL: anything else */
    const char *noun;
    void (*print)(Journal *journal, int index);
} EvaluationKind;

static const EvaluationKind *kind_of(Journal *journal, const int *indices, int count)
{
    static const EvaluationKind kinds[] = {{"objective", "evaluation", print_design},
                                           {"energy", "iteration", print_drawing},
                                           {NULL, "step", print_step}};
    const EvaluationKind *kind = kinds;
    for (bool has = false; kind->has && count > 0; kind++) {
        journal_has(journal, "evaluation", indices[0], kind->has, &has, NULL); /* journal_check says more */
        if (has) break;
    }
    return kind;
}

/* "b.run: not finished, 12 evaluations, 3 frames, 2 states". Once the result is safe, frames may be there only. */
static void print_journal(Journal *journal, const char *path, const char *noun, int count, int frames,
                          int states)
{
    bool finished = journal_is_finished(journal);
    char *done = count ? mem_format(", %d %s%s", count, noun, plural(count)) : mem_text("");
    say(stdout, "%s: %s%s, %d frame%s, %d state%s%s", path, finished ? "finished" : "not finished", done,
        frames, plural(frames), states, plural(states),
        finished && frames == 0 ? "; the frames are in the result" : "");
    mem_free(done);
}

static int info_journal(const char *path)
{
    Error err;
    Journal *journal = journal_open(path, JOURNAL_READ, &err);
    if (!journal) return verb_fail(RUN_REFUSED, err.text);
    int frames, states, *indices = NULL, count = 0;
    bool ok = journal_count(journal, "frame", &frames, &err) &&
              journal_count(journal, "state", &states, &err) &&
              journal_indices(journal, "evaluation", &indices, &count, &err);
    if (ok) {
        const EvaluationKind *kind = kind_of(journal, indices, count);
        print_journal(journal, path, kind->noun, count, frames, states);
        for (int k = 0; k < count; k++) {
            printf("  %4d", indices[k]);
            kind->print(journal, indices[k]);
        }
    }
    mem_free(indices);
    ok = ok && journal_check(journal, &err);
    if (!ok) say(stderr, "slender: %s", err.text);
    journal_close(journal, NULL);
    return ok ? RUN_DONE : RUN_REFUSED;
}

int verb_info(int argc, char **argv)
{
    static const char usage[] =
        "info NAME.vtkhdf | NAME.run\n  Lists what is in a result, or how far a run has come.";
    const char *path;
    int code;
    if (!options_parse(argc, argv, usage, NULL, 0, &path, &code)) return code;
    return path_has_ending(path, ".run") ? info_journal(path) : info_result(path);
}
