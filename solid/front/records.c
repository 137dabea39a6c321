/* Solids in the journal. */
#include "base/memory.h"
#include "job/run.h"
#include "solid/front/front.h"
#include "solid/stress.h"
#include <math.h>
#include <string.h>

/* Cells of a frame: the tetrahedra, and after them the faces of the skin. */
static int cell_count(const Solid *solid)
{
    return solid->tets->count + solid->tets->skin->face_count;
}

void solid_add_static(const Model *model, Arrays *list)
{
    const Tets *tets = ((const Solid *)model->self)->tets;
    const Mesh *surface = tets->surface, *skin = tets->skin;
    arrays_add(list, array_float("rest", "m", surface->rest[0], 2, surface->vertex_count, 3));
    arrays_add(list, array_int("cells", tets->nodes, 2, tets->count, tets->each));
    arrays_add(list, array_int("faces", skin->faces[0], 2, skin->face_count, 3));
    arrays_add(list, array_int("surface", surface->faces[0], 2, surface->face_count, 3));
    arrays_add(list, array_int("surface_of_face", tets->skin_face, 1, skin->face_count, 0));
    int *behind = arrays_keep(list, mem_alloc((size_t)skin->face_count, sizeof *behind));
    for (int f = 0; f < skin->face_count; f++) behind[f] = tets->behind[tets->skin_face[f]];
    arrays_add(list, array_int("cell_of_face", behind, 1, skin->face_count, 0));
    if (surface->vertex_count != surface->file_vertex_count)
        arrays_add(list, array_int("file_vertex", surface->file_vertex, 1, surface->vertex_count, 0));
}

/* A number, or width of them, for each cell: NaN in those that have none. */
static double *empty(const Solid *solid, int width, Arrays *list)
{
    size_t size = (size_t)cell_count(solid) * (size_t)width;
    double *values = arrays_numbers(list, size);
    for (size_t i = 0; i < size; i++) values[i] = NAN;
    return values;
}

static void add_cells(const Solid *solid, const char *name, const char *unit, const double *values, int width,
                      Arrays *list)
{
    arrays_add(list,
               array_float(name, unit, values, width > 1 ? 2 : 1, cell_count(solid), width > 1 ? width : 0));
}

/* Does the face of the skin have the layer? */
static bool has_layer(const Solid *solid, int face)
{
    return solid->skin > 0 && (!solid->skin_on || solid->skin_on[solid->tets->skin_face[face]]);
}

static void add_magnetization(const Solid *solid, const double *p, Arrays *list)
{
    const Tets *tets = solid->tets;
    double *M = empty(solid, 3, list);
    memcpy(M, p + solid->volume_magnetization, 3 * (size_t)tets->count * sizeof *M);
    for (int f = 0; f < tets->skin->face_count; f++)
        if (has_layer(solid, f))
            memcpy(M + 3 * (tets->count + f), p + solid->magnetization + 3 * tets->skin_face[f],
                   3 * sizeof *M);
    add_cells(solid, "cell/magnetization", "A/m", M, 3, list);
}

static void add_young(const Solid *solid, const double *p, Arrays *list)
{
    const Tets *tets = solid->tets;
    double *young = empty(solid, 1, list);
    memcpy(young, p + solid->young, (size_t)tets->count * sizeof *young);
    for (int f = 0; solid->film && f < tets->skin->face_count; f++)
        if (has_layer(solid, f)) young[tets->count + f] = p[solid->skin_young + tets->skin_face[f]];
    add_cells(solid, "cell/young", "Pa", young, 1, list);
}

/* Is each of the term's elements a tetrahedron? The skin may have as many faces. */
static bool is_of_tets(const Solid *solid, const Term *term)
{
    return term->ops->size(term->self) == 3 * solid->tets->each &&
           term->ops->count(term->self) == solid->tets->count;
}

void solid_add_frame(const Model *model, const Snapshot *shot, bool whole, Arrays *list)
{
    const Solid *solid = model->self;
    System *sys = shot->load_case->sys;
    Point at = state_point(&shot->at, shot->p);
    for (int t = 0; t < system_term_count(sys); t++) {
        const Term *term = system_term(sys, t);
        if (!is_of_tets(solid, term)) continue;
        double *energy = empty(solid, 1, list);
        system_term_energy(sys, t, &at, energy);
        char *name = arrays_keep(list, mem_format("cell/energy_%s", term->ops->name));
        add_cells(solid, name, "J", energy, 1, list);
    }
    double *least = empty(solid, 1, list);
    solid_jacobians(solid, shot->at.x, least);
    add_cells(solid, "cell/least_jacobian", "", least, 1, list);
    if (!whole) return;
    add_magnetization(solid, shot->p, list);
    add_young(solid, shot->p, list);
}

void solid_add_state(const Model *model, const Snapshot *shot, const char *prefix, Arrays *list)
{
    System *sys = shot->load_case->sys;
    Point at = state_point(&shot->at, shot->p);
    double *gradient = arrays_numbers(list, (size_t)system_dof_count(sys)), *least = arrays_numbers(list, 1);
    system_gradient(sys, &at, gradient);
    char *name = arrays_keep(list, mem_format("%s/gradient", prefix));
    arrays_add(list, array_float(name, "N", gradient, 2, model->point_count, 3));
    int tet;
    *least = solid_least_jacobian(model->self, shot->at.x, &tet);
    arrays_add(list,
               array_float(arrays_keep(list, mem_format("%s/least_jacobian", prefix)), "", least, 0, 0, 0));
}

/* Of the faces of a skin that is a film: the stress of its material in plane stress. */
static void put_film(const Solid *solid, const Snapshot *shot, double *von_mises)
{
    const Mesh *skin = solid->tets->skin;
    for (int f = 0; solid->film && f < skin->face_count; f++) {
        if (!has_layer(solid, f)) continue;
        PlaneTensor strain = membrane_strain(solid->tets->surface->rest, shot->at.x, skin->faces[f]);
        von_mises[f] = shot->p[solid->skin_young + solid->tets->skin_face[f]] *
                       membrane_von_mises(solid->film_material, solid->film_poisson, strain);
    }
}

void solid_add_stress(const Model *model, const Snapshot *shot, Arrays *list)
{
    const Solid *solid = model->self;
    int count = solid->tets->count;
    Point at = state_point(&shot->at, shot->p);
    TetStress *stress = mem_alloc((size_t)count, sizeof *stress);
    double *cauchy = empty(solid, 6, list), *von_mises = empty(solid, 1, list),
           *stretch = empty(solid, 1, list);
    solid_stresses(solid, shot->load_case->sys, &at, stress);
    for (int t = 0; t < count; t++) {
        memcpy(cauchy + 6 * t, stress[t].cauchy, sizeof stress[t].cauchy);
        von_mises[t] = stress[t].von_mises, stretch[t] = stress[t].stretch;
    }
    put_film(solid, shot, von_mises + count);
    add_cells(solid, "cell/cauchy_stress", "Pa", cauchy, 6, list);
    add_cells(solid, "cell/von_mises", "Pa", von_mises, 1, list);
    add_cells(solid, "cell/stretch", "", stretch, 1, list);
    mem_free(stress);
}
