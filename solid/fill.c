/* Filling by TetGen. */
#include "solid/fill.h"
#include "base/memory.h"
#include "base/vec3.h"
#include "io/program.h"
#include "io/tetgen.h"
#include "solid/shapes.h"
#include "solid/tets.h"
#include <math.h>

/* p: a surface; Y: keep it; q, a: quality and the volume of a regular tetrahedron of edge 1, in units of the size; z: count
 * from 0; Q: say nothing but errors. */
static const char *const SWITCHES = "-pYq1.4a0.118zQ";

static bool check_closed(const Mesh *surface, Error *err)
{
    for (int e = 0; e < surface->edge_count; e++)
        if (mesh_edge_is_boundary(surface, e))
            return error_set(
                err, "the surface is open at its edge from vertex %d to %d; only a closed one can be filled",
                surface->file_vertex[surface->edges[e][0]], surface->file_vertex[surface->edges[e][1]]);
    return true;
}

/* TetGen would make, without a word, what no memory holds. */
static bool check_count(const Mesh *surface, double size, Error *err)
{
    const double regular = 0.118; /* volume of a regular tetrahedron of edge 1 */
    double volume = 0, middle[3] = {0};
    for (int i = 0; i < 3 * surface->vertex_count; i++)
        middle[i % 3] += surface->rest[i / 3][i % 3] / surface->vertex_count;
    for (int f = 0; f < surface->face_count; f++) {
        Vec3 x[3];
        for (int i = 0; i < 3; i++)
            x[i] = vec3_sub(vec3_load(surface->rest[surface->faces[f][i]]), vec3_load(middle));
        volume += vec3_dot(x[0], vec3_cross(x[1], x[2])) / 6;
    }
    return solid_shape_check_count(ceil(fabs(volume) / (regular * size * size * size)), err) ||
           error_prefix(err, "edges of %.3g m in %.3g m^3 (is the file in millimetres? then `scale: 1.0e-3`)",
                        size, fabs(volume));
}

/* Faces and groups as they were; the vertices to the last bit. */
static void take_surface(const Mesh *surface, double size, MeshFile *mesh)
{
    for (int v = 0; v < mesh->vertex_count; v++)
        for (int i = 0; i < 3; i++)
            mesh->vertices[v][i] =
                v < surface->vertex_count ? surface->rest[v][i] : size * mesh->vertices[v][i];
    mesh->face_count = surface->face_count;
    mesh->faces = mem_copy(surface->faces, (size_t)surface->face_count, sizeof *mesh->faces);
    mesh->group_count = surface->group_count;
    mesh->groups = mem_copy(surface->groups, (size_t)surface->group_count, sizeof *mesh->groups);
    for (int g = 0; g < mesh->group_count; g++) {
        MeshGroup *group = &mesh->groups[g];
        group->name = mem_text(group->name);
        group->members =
            mem_copy(group->members, (size_t)group->count * (group->dim == 1 ? 2 : 1), sizeof(int));
    }
}

/* The vertices that were given are the first of those that came back. */
static bool check_kept(const Mesh *surface, double size, const MeshFile *mesh, Error *err)
{
    bool kept = mesh->vertex_count >= surface->vertex_count;
    for (int i = 0; kept && i < 3 * surface->vertex_count; i++) {
        double was = surface->rest[i / 3][i % 3] / size;
        kept = fabs(mesh->vertices[i / 3][i % 3] - was) <= 1e-9 * (1 + fabs(was));
    }
    return kept || error_set(err, "tetgen has changed the surface, which it was told to keep");
}

/* The surface of the tetrahedra is the one that was given. */
static bool check_surface(const Mesh *surface, const MeshFile *mesh, Error *err)
{
    Tets *tets = tets_create(mesh, TET_LINEAR, NULL, err);
    if (!tets) return false;
    int count = tets->surface->face_count;
    tets_destroy(tets);
    return count == surface->face_count || error_set(err,
                                                     "the surface has %d faces, and what tetgen made of it "
                                                     "%d: a surface within another is filled, too, "
                                                     "and cannot be a cavity",
                                                     surface->face_count, count);
}

static bool run(const Mesh *surface, double size, const char *folder, MeshFile *mesh, Error *err)
{
    char *stem = mem_format("%s/surface", folder), *input = mem_format("%s.smesh", stem),
         *output = mem_format("%s.1", stem);
    const char *const arguments[] = {"tetgen", SWITCHES, input, NULL};
    bool ok = tetgen_write(input, (const double(*)[3])surface->rest, surface->vertex_count, 1 / size,
                           (const int(*)[3])surface->faces, surface->face_count, err) &&
              program_run(arguments, folder,
                          "Debian has it as tetgen; or fill the surface with gmsh and give its .msh as "
                          "`file`",
                          err) &&
              tetgen_read(output, mesh, err) && check_kept(surface, size, mesh, err);
    mem_free(stem);
    mem_free(input);
    mem_free(output);
    return ok;
}

bool solid_fill(const Mesh *surface, double size, MeshFile *mesh, Error *err)
{
    char *folder;
    *mesh = (MeshFile){0};
    if (!check_closed(surface, err) || !check_count(surface, size, err) || !program_folder(&folder, err))
        return false;
    bool ok = run(surface, size, folder, mesh, err);
    program_remove_folder(folder);
    if (ok) take_surface(surface, size, mesh);
    ok = ok && check_surface(surface, mesh, err);
    if (!ok) mesh_file_clear(mesh);
    return ok;
}
