#include "view/show.h"
#include "base/memory.h"
#include "base/vec3.h"
#include "spline/drawn.h"
#include "view/show_data.h"
#include "view/show_drawing.h"
#include "view/show_obstacles.h"
#include "view/show_rod.h"
#include "view/ticks.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* A page of a mesh. */
typedef struct Show {
    ShowData *data;
    const ShowDef *def;
    int vertex_count, face_count;
    const int (*faces)[3];
    const double (*rest)[3], (*magnetization)[3];
    bool magnetic; /* somewhere */
    bool filled;   /* with tetrahedra */
    char *field;
    PicturePanel *panels;
    int *steps; /* [panel] the frame that it shows; -1: the last */
    int panel_count;
    ShowObstacles obstacles;
} Show;

ShowDef show_default(void)
{
    return (ShowDef){.frame = -1, .arrows = true, .history = true, .width = 1600};
}

/* A dataset with width numbers for each face, or, of a solid, for each face of the surface that the skin's are parts of; NULL:
 * there is none. */
static double *per_face(Show *show, const char *path, int width)
{
    size_t faces = (size_t)show->face_count, each = (size_t)width;
    const int *part = show_dataset(show->data, "slender/surface_of_face", ARRAY_INT32, faces);
    if (!part) return show_dataset(show->data, path, ARRAY_FLOAT64, each * faces);
    int rows = 0;
    for (int f = 0; f < show->face_count; f++) rows = part[f] >= rows ? part[f] + 1 : rows;
    const double *own = show_dataset(show->data, path, ARRAY_FLOAT64, each * (size_t)rows);
    double *values = own ? show_block(show->data, each * faces, sizeof *values) : NULL;
    for (int f = 0; own && f < show->face_count; f++)
        if (part[f] >= 0)
            memcpy(values + each * (size_t)f, own + each * (size_t)part[f], each * sizeof *values);
    return values;
}

static bool read_mesh(Show *show, Error *err)
{
    Array faces, rest;
    if (!result_read_as(show->data->result, "slender/faces", ARRAY_INT32, 2, 3, &faces, err)) return false;
    show_keep(show->data, faces);
    if (!result_read_as(show->data->result, "slender/rest", ARRAY_FLOAT64, 2, 3, &rest, err)) return false;
    show_keep(show->data, rest);
    for (size_t i = 0; i < array_count(&faces); i++) {
        int vertex = ((const int *)faces.data)[i];
        if (vertex < 0 || vertex >= rest.dims[0])
            return error_set(err, "the result's faces name vertices that it does not have");
    }
    if (faces.dims[0] == 0) return error_set(err, "the result's mesh has no faces");
    show->face_count = faces.dims[0];
    show->vertex_count = rest.dims[0];
    show->filled = result_has(show->data->result, "slender/cells");
    show->faces = (void *)faces.data;
    show->rest = (void *)rest.data;
    show->magnetization = (void *)per_face(show, "slender/design/magnetization", 3);
    for (int i = 0; show->magnetization && i < 3 * show->face_count; i++)
        show->magnetic |= show->magnetization[i / 3][i % 3] != 0;
    return true;
}

/* ---- What is drawn on the faces ---- */

typedef struct Edges {
    Vec3 e1, e2, n;
} Edges;

static Edges face_edges(const Show *show, const double (*x)[3], int face)
{
    const int *v = show->faces[face];
    Vec3 x0 = vec3_load(x[v[0]]), e1 = vec3_sub(vec3_load(x[v[1]]), x0),
         e2 = vec3_sub(vec3_load(x[v[2]]), x0);
    return (Edges){e1, e2, vec3_unit(vec3_cross(e1, e2))};
}

/* Magnetisation as the faces carry it: M = a e1 + b e2 + c n at rest is a e1' + b e2' + c n' now. */
static const double (*carried(Show *show, const double (*x)[3], const double (*M)[3]))[3]
{
    double(*vectors)[3] = show_block(show->data, (size_t)show->face_count, sizeof *vectors);
    for (int f = 0; f < show->face_count; f++) {
        Edges rest = face_edges(show, show->rest, f), now = face_edges(show, x, f);
        Vec3 m = vec3_load(M[f]);
        double e11 = vec3_dot(rest.e1, rest.e1), e12 = vec3_dot(rest.e1, rest.e2),
               e22 = vec3_dot(rest.e2, rest.e2);
        double m1 = vec3_dot(rest.e1, m), m2 = vec3_dot(rest.e2, m), det = e11 * e22 - e12 * e12;
        double a = (e22 * m1 - e12 * m2) / det, b = (e11 * m2 - e12 * m1) / det;
        Vec3 turned = vec3_scale(vec3_dot(rest.n, m), now.n);
        vec3_store(vectors[f], vec3_axpy(a, now.e1, vec3_axpy(b, now.e2, turned)));
    }
    return (const double(*)[3])vectors;
}

static bool varies(const double *values, int count)
{
    for (int f = 1; values && f < count; f++)
        if (fabs(values[f] - values[0]) > 1e-9 * fabs(values[0])) return true;
    return false;
}

static const double *lengths(Show *show, const double (*vectors)[3])
{
    double *r = show_block(show->data, (size_t)show->face_count, sizeof *r);
    for (int f = 0; f < show->face_count; f++) r[f] = vec3_length(vec3_load(vectors[f]));
    return r;
}

/* The sizes of vectors at the points, as the mean of a face's corners. */
static const double *means_of_corners(Show *show, const double (*vectors)[3])
{
    double *mean = show_block(show->data, (size_t)show->face_count, sizeof *mean);
    for (int f = 0; f < show->face_count; f++)
        for (int i = 0; i < 3; i++) mean[f] += vec3_length(vec3_load(vectors[show->faces[f][i]])) / 3;
    return mean;
}

/* Of a frame, -1: the last: one number per face of CellData, or vectors of PointData. */
static bool frame_field(Show *show, int step, const char *name, const double **values, const char **unit,
                        Error *err)
{
    Array array;
    bool points = result_has(show->data->result, show_text(show->data, "VTKHDF/PointData/%s", name));
    if (step < 0) step = result_step_count(show->data->result) - 1;
    const char *path = show_text(show->data, "%s/%s", points ? "PointData" : "CellData", name);
    if (!result_read_step(show->data->result, path, step, &array, err)) return false;
    void *data = show_keep(show->data, array);
    *unit = array.unit && array.unit[0] ? array.unit : "";
    if (points && array_is(&array, ARRAY_FLOAT64, 2, 3) && array.dims[0] == show->vertex_count)
        return *values = means_of_corners(show, (const double(*)[3])data), true;
    size_t faces = (size_t)show->face_count, rows = array_count(&array);
    bool fits = !points && array.type == ARRAY_FLOAT64 && (rows == faces || (show->filled && rows > faces));
    if (!fits) return error_set(err, "'%s' is neither one number per face nor a vector per point", name);
    *values = (const double *)data + (rows - faces); /* a solid's skin is after its tetrahedra */
    return true;
}

/* Numbers per face of the field that was asked for; NULL: a plain surface. False where there is no such
 * field. */
static bool face_field(Show *show, int step, const double **values, const char **name, const char **unit,
                       Error *err)
{
    const double *young =
        show->filled ? NULL : /* of a solid it is that of its tetrahedra */
            show_dataset(show->data, "slender/design/young", ARRAY_FLOAT64, (size_t)show->face_count);
    const char *asked = show->def->field;
    *values = NULL;
    if (!asked) asked = varies(young, show->face_count) ? "young" : show->magnetic ? "magnetization" : "none";
    *name = asked, *unit = "";
    if (!strcmp(asked, "none")) return true;
    if (!strcmp(asked, "young") && young) return *values = young, *unit = "Pa", true;
    if (!strcmp(asked, "magnetization") && show->magnetization)
        return *values = lengths(show, show->magnetization), *unit = "A/m", true;
    return frame_field(show, step, asked, values, unit, err);
}

/* ---- Panels ---- */

static PicturePanel *add_panel(Show *show, const char *name, const double (*x)[3])
{
    size_t count = (size_t)show->panel_count++;
    show->panels = mem_resize(show->panels, count, count + 1, sizeof *show->panels);
    show->steps = mem_resize(show->steps, count, count + 1, sizeof *show->steps);
    show->steps[count] = -1;
    PicturePanel *panel = &show->panels[count];
    *panel = (PicturePanel){.name = name, .x = x};
    if (show->def->arrows && show->magnetic) panel->vectors = carried(show, x, show->magnetization);
    return panel;
}

/* A frame, with its field. */
static bool add_frame(Show *show, int frame, Error *err)
{
    Array array, flux;
    Result *result = show->data->result;
    if (!show_check_frame(show->data, frame, err)) return false;
    if (!result_read_step(result, "Points", frame, &array, err)) return false;
    const double(*points)[3] = show_keep(show->data, array);
    if (array.dims[0] != show->vertex_count)
        return error_set(err, "the result's frame %d has other points than its mesh", frame);
    PicturePanel *panel = add_panel(show, show_frame_name(show->data, frame), points);
    show->steps[show->panel_count - 1] = frame;
    if (show->data->motion)
        panel->gravity = show_dataset(show->data, "slender/design/gravity", ARRAY_FLOAT64, 3);
    if (result_has(result, "slender/frames/flux_density") &&
        result_read_rows(result, "slender/frames/flux_density", frame, 1, &flux, NULL)) {
        char number[64];
        const double *B = show_keep(show->data, flux);
        if (!array_is(&flux, ARRAY_FLOAT64, 2, 3))
            return error_set(err, "slender/frames/flux_density is not as slender writes it");
        panel->flux_density = B;
        unit_format(vec3_length(vec3_load(panel->flux_density)), "T", number, sizeof number);
        panel->note = show_text(show->data, "B = %s", number);
    }
    return true;
}

/* An array of a case, or NULL. */
static void *case_dataset(Show *show, const char *name, const char *what, size_t count)
{
    char *path = mem_format("slender/cases/%s/%s", name, what);
    void *data = show_dataset(show->data, path, ARRAY_FLOAT64, count);
    mem_free(path);
    return data;
}

static void add_case(Show *show, const char *name)
{
    size_t count = 3 * (size_t)show->vertex_count;
    const double(*x)[3] = case_dataset(show, name, "x", count);
    if (!x) return;
    PicturePanel *panel = add_panel(show, show_text(show->data, "%s", name), x);
    panel->target = case_dataset(show, name, "target", count);
    panel->gravity = case_dataset(show, name, "gravity", 3);
    const double *flux = case_dataset(show, name, "flux_density", 3);
    if (flux && vec3_length(vec3_load(flux)) > 0) panel->flux_density = flux;
    Array status;
    char *path = mem_format("slender/cases/%s/status", name);
    if (result_read_as(show->data->result, path, ARRAY_TEXT, 1, 0, &status, NULL)) {
        panel->note = show_text(show->data, "%s", (const char *)status.data);
        array_clear(&status);
    }
    mem_free(path);
}

/* The cases in the scene's order, or the one asked for. */
static bool add_cases(Show *show, Error *err)
{
    Array names;
    if (!result_has(show->data->result, "slender/case_names"))
        return error_set(err, "the result has no state yet");
    if (!result_read_as(show->data->result, "slender/case_names", ARRAY_TEXT, 1, 0, &names, err))
        return false;
    char *rest = NULL;
    for (char *name = strtok_r((char *)names.data, "\n", &rest); name; name = strtok_r(NULL, "\n", &rest))
        if (!show->def->only || !strcmp(show->def->only, name)) add_case(show, name);
    array_clear(&names);
    if (show->panel_count == 0)
        return error_set(err, "the result has no load case '%s'", show->def->only ? show->def->only : "");
    return true;
}

/* The colours, and what the arrows are. */
static bool dress(Show *show, PictureScene *page, Error *err)
{
    page->vectors_name = "magnetization", page->vectors_unit = "A/m";
    for (int k = 0; k < show->panel_count; k++)
        if (!face_field(show, show->steps[k], &show->panels[k].field, &page->field_name, &page->field_unit,
                        err))
            return false;
    return true;
}

/* What was asked for: moments for an animation or stills, one frame, or the final state of each case. */
static bool add_panels(Show *show, Error *err)
{
    if (show->def->frame >= 0) return add_frame(show, show->def->frame, err);
    int count = show_frame_count(show->data);
    for (int k = 0; k < count; k++)
        if (!add_frame(show, show_frame(show->data, k), err)) return false;
    if (count > 0) return true;
    bool frames = show->def->seconds > 0 || show->def->stills > 0;
    return frames ? show_check_frame(show->data, 0, err) : add_cases(show, err);
}

/* What the body meets, in each panel; what of it the pictures have room for follows from where the body is in all. */
static bool add_obstacles(Show *show, Error *err)
{
    if (!show_obstacles_read(&show->obstacles, show->data, err)) return false;
    ShowWay way = show_way();
    for (int k = 0; k < show->panel_count; k++) show_way_add(&way, show->panels[k].x, show->vertex_count);
    for (int k = 0; k < show->panel_count; k++) {
        PicturePanel *panel = &show->panels[k];
        panel->around = show_obstacles_at(&show->obstacles, show->steps[k]);
        show_obstacles_find_near(&show->obstacles, way, &panel->around);
    }
    return true;
}

static bool write_page(Show *show, const char *result, const char *picture, Error *err)
{
    const ShowDef *def = show->def;
    PictureScene page = picture_default();
    if (!read_mesh(show, err)) return false;
    if (!add_panels(show, err) || !add_obstacles(show, err)) return false;
    if (!dress(show, &page, err)) return false;
    const char *slash = strrchr(result, '/');
    page.title = slash ? slash + 1 : result;
    page.vertex_count = show->vertex_count, page.face_count = show->face_count, page.faces = show->faces;
    page.panel_count = show->panel_count, page.panels = show->panels;
    page.target = def->target, page.width = def->width;
    memcpy(page.view, def->view, sizeof page.view);
    page.same_view = show->steps[0] >= 0;
    show->data->drawn = true;
    if (def->seconds > 0) return picture_animate(picture, &page, def->seconds / show->panel_count, err);
    Chart history;
    if (show_history(show->data, &history)) page.history = &history;
    return picture_write(picture, &page, err);
}

ShowStatus show_result(const char *result, const char *picture, const ShowDef *def, Error *err)
{
    ShowData data = {0};
    Show show = {.data = &data, .def = def};
    bool ok = show_data_open(&data, result, def, err);
    if (ok && drawn_has(data.result))
        ok = show_drawing(&data, picture, err);
    else if (ok && show_has_rod(&data))
        ok = show_rod(&data, result, picture, err);
    else
        ok = ok && write_page(&show, result, picture, err);
    mem_free(show.panels);
    mem_free(show.steps);
    show_data_clear(&data);
    return ok ? SHOW_DONE : data.drawn ? SHOW_CANNOT_WRITE : SHOW_HAS_NOT;
}
