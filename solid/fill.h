/* fill.h - a closed surface filled with tetrahedra by TetGen [Si 2015], a program of its own (Debian: tetgen). */
#pragma once
#include "surface/mesh.h"

/* Tetrahedra within the surface, which stays as it is: its vertices come first, in its order, its faces and groups are the
 * file's. None is larger than a regular one with edges of that size, in m, and none has a circumscribed ball of more than 1.4
 * times its shortest edge, but where the surface leaves no choice. Refused with a sentence: an open surface; a program that is
 * not there, that fails, or that gave back another surface, as where one lies within another (cavities are not left open). */
bool solid_fill(const Mesh *surface, double size, MeshFile *mesh, Error *err);
