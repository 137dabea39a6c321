/* obstacle_fixture.h - gaps, and closed meshes, for tests of obstacles. */
#pragma once
#include "base/memory.h"
#include "base/vec3.h"
#include "world/obstacle_shapes.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

static const RigidPose here = {.turn = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

static inline double value_at(const Obstacle *obstacle, double x, double y, double z)
{
    Gap gap;
    obstacle_gap(obstacle, &here, (double[3]){x, y, z}, &gap);
    return gap.value;
}

/* Three expressions of t. */
static inline Timed of_time(const char *x, const char *y, const char *z)
{
    Error err;
    const char *const t[] = {"t", NULL};
    Timed timed = {.formula = formula_create((const char *[]){x, y, z}, 3, NULL, 0, t, &err),
                   .first = TIMED_ALONE};
    assert_non_null(timed.formula);
    return timed;
}

/* least: of the gradient's length. */
static inline void assert_finite(const Gap *gap, double least)
{
    double length = 0;
    assert_true(isfinite(gap->value));
    for (int i = 0; i < 3; i++) {
        length += gap->gradient[i] * gap->gradient[i];
        for (int j = 0; j < 3; j++) assert_true(isfinite(gap->hessian[i][j]));
    }
    if (!(isfinite(length) && sqrt(length) >= least)) fail_msg("a gradient of length %g", sqrt(length));
}

static inline void assert_near(double value, double exact, double error)
{
    if (!(fabs(value - exact) <= error)) fail_msg("%.15g, and exactly %.15g", value, exact);
}

/* ---- Meshes ---- */

/* A box of so many cells along each side of each face: a cube, or, `radius` given, a ball. Closed, outwards. */
static inline MeshFile make_block(int n, double half, double radius)
{
    MeshFile file = {.path = mem_text("block.obj"), .face_count = 12 * n * n};
    int side = n + 1;
    file.vertices = mem_alloc((size_t)(6 * side * side), sizeof *file.vertices);
    file.faces = mem_alloc((size_t)file.face_count, sizeof *file.faces);
    int(*face)[3] = file.faces;
    for (int f = 0; f < 6; f++)
        for (int i = 0; i < side; i++)
            for (int j = 0; j < side; j++) {
                int axis = f / 2, v = file.vertex_count++;
                double *x = file.vertices[v], sign = f % 2 ? 1 : -1;
                x[axis] = sign * half;
                x[(axis + 1) % 3] = half * (2.0 * i / n - 1);
                x[(axis + 2) % 3] = half * (2.0 * j / n - 1);
                double length = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
                for (int k = 0; radius > 0 && k < 3; k++) x[k] *= radius / length;
                if (i == n || j == n) continue;
                int a = v, b = v + side, c = v + side + 1, d = v + 1, swap = sign < 0;
                memcpy(face++, (int[3]){a, swap ? c : b, swap ? b : c}, sizeof *face);
                memcpy(face++, (int[3]){a, swap ? d : c, swap ? c : d}, sizeof *face);
            }
    return file;
}

static inline void turn_faces(MeshFile *file, int count)
{
    for (int f = 0; f < count; f++) {
        int swap = file->faces[f][1];
        file->faces[f][1] = file->faces[f][2];
        file->faces[f][2] = swap;
    }
}

static inline Obstacle mesh_obstacle(MeshFile *file, double cell)
{
    Obstacle obstacle;
    Error err;
    if (!obstacle_mesh(file, cell, &obstacle, &err)) fail_msg("%s", err.text);
    mesh_file_clear(file);
    return obstacle;
}

/* ---- Surfaces ---- */

/* Of a surface in a box from -2 to 2: all vertices have phi = 0, normals are those of phi, and the area is that, to a part
 * of it. */
static inline void check_surface(const Obstacle *obstacle, double area, double part)
{
    MeshFile surface;
    double sum = 0;
    obstacle_surface(obstacle, (const double[2][3]){{-2, -2, -2}, {2, 2, 2}}, &surface);
    assert_in_range(surface.face_count, 1, 16384);
    for (int v = 0; v < surface.vertex_count; v++) {
        const double *x = surface.vertices[v];
        assert_near(value_at(obstacle, x[0], x[1], x[2]), 0, 1e-9);
    }
    for (int f = 0; f < surface.face_count; f++) {
        Vec3 x[3];
        double middle[3];
        for (int k = 0; k < 3; k++) x[k] = vec3_load(surface.vertices[surface.faces[f][k]]);
        vec3_store(middle, vec3_scale(1.0 / 3, vec3_add(x[0], vec3_add(x[1], x[2]))));
        Vec3 normal = vec3_scale(0.5, vec3_cross(vec3_sub(x[1], x[0]), vec3_sub(x[2], x[0])));
        Gap gap;
        obstacle_gap(obstacle, &here, middle, &gap);
        Vec3 gradient = vec3_unit(vec3_load(gap.gradient));
        if (!(vec3_dot(normal, gradient) > 0.7 * vec3_length(normal)))
            fail_msg("%s: face %d looks elsewhere", obstacle->ops->kind, f);
        sum += vec3_length(normal);
    }
    assert_near(sum, area, part * area);
    mesh_file_clear(&surface);
}
