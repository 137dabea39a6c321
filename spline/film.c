#include "spline/film.h"
#include "base/memory.h"
#include <math.h>
#include <string.h>

static const double GRAIN = 1e-6; /* m */

/* ---- Writing ---- */

bool film_put(Journal *journal, const SplinePage *page, const Strokes *strokes, int iteration, Error *err)
{
    static const int none[] = {0};
    Arrays list = {0};
    int count = strokes_node_count(strokes);
    int *nodes = arrays_keep(&list, mem_alloc(4 * (size_t)count, sizeof *nodes));
    for (int i = 0; i < 4 * count; i++) {
        double corner = i % 4 == 0 ? page->left : i % 4 == 1 ? page->top : 0;
        nodes[i] = (int)lround((corner + page->unit * strokes->q[i]) / GRAIN);
    }
    arrays_add(&list, array_int("nodes", nodes, 2, count, 4));
    arrays_add(&list, array_int("strokes", strokes->count ? strokes->start : none, 1, strokes->count + 1, 0));
    arrays_add(&list, array_int("pen", strokes->layer, 1, strokes->count, 0));
    return arrays_put(&list, journal, "film", iteration, err);
}

/* Whole numbers one after the other. */
typedef struct Numbers {
    int *values;
    size_t count;
} Numbers;

/* Adds `shift` to each. */
static void append(Numbers *numbers, const int *values, size_t count, int shift)
{
    numbers->values = mem_resize(numbers->values, numbers->count, numbers->count + count, sizeof(int));
    for (size_t k = 0; k < count; k++) numbers->values[numbers->count + k] = values[k] + shift;
    numbers->count += count;
}

typedef struct Reel {
    Numbers iteration, frames, strokes, pen, nodes;
} Reel;

static bool append_frame(Reel *reel, Journal *journal, int iteration, Error *err)
{
    Array strokes = {0}, pen = {0}, nodes = {0};
    bool ok = journal_get(journal, "film", iteration, "strokes", &strokes, err) &&
              journal_get(journal, "film", iteration, "pen", &pen, err) &&
              journal_get(journal, "film", iteration, "nodes", &nodes, err);
    if (ok) {
        append(&reel->iteration, &iteration, 1, 0);
        append(&reel->frames, &(int){(int)reel->pen.count}, 1, 0);
        append(&reel->strokes, strokes.data, array_count(&strokes) - 1, (int)(reel->nodes.count / 4));
        append(&reel->pen, pen.data, array_count(&pen), 0);
        append(&reel->nodes, nodes.data, array_count(&nodes), 0);
    }
    array_clear(&strokes);
    array_clear(&pen);
    array_clear(&nodes);
    return ok;
}

static void add_numbers(Arrays *list, const char *name, const char *unit, const Numbers *numbers, int width)
{
    arrays_keep(list, numbers->values);
    int rows = (int)numbers->count / (width ? width : 1);
    Array array = array_int(name, numbers->values, width ? 2 : 1, rows, width);
    array.unit = unit;
    arrays_add(list, array);
}

bool film_add(Journal *journal, Arrays *list, Error *err)
{
    Reel reel = {.iteration = {0}};
    int *iterations, count;
    if (!journal_indices(journal, "film", &iterations, &count, err)) return false;
    bool ok = true;
    for (int k = 0; ok && k < count; k++) ok = append_frame(&reel, journal, iterations[k], err);
    mem_free(iterations);
    if (count == 0) return true;
    append(&reel.frames, &(int){(int)reel.pen.count}, 1, 0);
    append(&reel.strokes, &(int){(int)(reel.nodes.count / 4)}, 1, 0);
    add_numbers(list, "spline/film/iteration", "", &reel.iteration, 0);
    add_numbers(list, "spline/film/frames", "", &reel.frames, 0);
    add_numbers(list, "spline/film/strokes", "", &reel.strokes, 0);
    add_numbers(list, "spline/film/pen", "", &reel.pen, 0);
    add_numbers(list, "spline/film/nodes", "um", &reel.nodes, 4);
    return ok;
}

/* ---- Reading ---- */

static const int *numbers_of(const Array *array)
{
    return array->data;
}

/* Offsets that do not fall, from 0 to an end, at least `step` apart. */
static bool offsets_fit(const Array *array, int end, int step)
{
    int count = (int)array_count(array);
    const int *offsets = array->data;
    bool fit = count > 0 && offsets[0] == 0 && offsets[count - 1] == end;
    for (int k = 1; fit && k < count; k++) fit = offsets[k] >= offsets[k - 1] + step && offsets[k] <= end;
    return fit;
}

static bool film_fits(const Film *film, int pens)
{
    int strokes = (int)array_count(&film->pen);
    bool fit = (int)array_count(&film->frames) == film->count + 1 && offsets_fit(&film->frames, strokes, 0) &&
               (int)array_count(&film->strokes) == strokes + 1 &&
               offsets_fit(&film->strokes, film->nodes.dims[0], 2);
    for (int k = 0; fit && k < strokes; k++)
        fit = numbers_of(&film->pen)[k] >= 0 && numbers_of(&film->pen)[k] < pens;
    return fit;
}

bool film_read(Result *result, const Drawn *drawn, Film *film, Error *err)
{
    *film = (Film){0};
    if (!result_has(result, "slender/spline/film/frames")) return true;
    if (!result_read_as(result, "slender/spline/film/iteration", ARRAY_INT32, 1, 0, &film->iteration, err) ||
        !result_read_as(result, "slender/spline/film/frames", ARRAY_INT32, 1, 0, &film->frames, err) ||
        !result_read_as(result, "slender/spline/film/strokes", ARRAY_INT32, 1, 0, &film->strokes, err) ||
        !result_read_as(result, "slender/spline/film/pen", ARRAY_INT32, 1, 0, &film->pen, err) ||
        !result_read_as(result, "slender/spline/film/nodes", ARRAY_INT32, 2, 4, &film->nodes, err))
        return false;
    film->count = (int)array_count(&film->iteration);
    return film_fits(film, drawn->pen_count) ||
           error_set(err, "slender/spline/film is not as slender writes it");
}

void film_clear(Film *film)
{
    array_clear(&film->iteration);
    array_clear(&film->frames);
    array_clear(&film->strokes);
    array_clear(&film->pen);
    array_clear(&film->nodes);
}

int film_iteration(const Film *film, int frame)
{
    return numbers_of(&film->iteration)[frame];
}

Plot film_plot(const Film *film, const Drawn *drawn, int frame)
{
    const int *frames = film->frames.data, *start = film->strokes.data;
    const SplinePage *page = &drawn->page;
    Strokes strokes = {0};
    for (int s = frames[frame]; s < frames[frame + 1]; s++) {
        int count = start[s + 1] - start[s];
        const int *from = numbers_of(&film->nodes) + 4 * (size_t)start[s];
        double(*q)[4] = strokes_extend(&strokes, count, numbers_of(&film->pen)[s]);
        for (int i = 0; i < 4 * count; i++) {
            double corner = i % 4 == 0 ? page->left : i % 4 == 1 ? page->top : 0;
            q[i / 4][i % 4] = (GRAIN * from[i] - corner) / page->unit;
        }
    }
    Plot plot = spline_plot(&strokes, page, drawn->pens, drawn->pen_count, drawn->paper);
    strokes_clear(&strokes);
    return plot;
}
