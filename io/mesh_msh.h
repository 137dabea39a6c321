/* mesh_msh.h - what the two halves of the reader of Gmsh's .msh share. Private to io/mesh_msh*.c. */
#pragma once
#include "io/mesh_reader.h"

typedef struct MshNode {
    long tag;
    int vertex;
} MshNode;

/* What names a physical group or an entity; first in each, to be compared by it. */
typedef struct MshTag {
    int dim;
    long tag;
} MshTag;

typedef struct MshPhysical {
    MshTag at;
    Word name;
} MshPhysical;

/* Of 4.1: an entity and one of the physical groups it is in. */
typedef struct MshEntity {
    MshTag at;
    long physical;
} MshEntity;

enum { MSH_MAX_NODES = 10 };

/* An element of 2.2: one that is in several physical groups is written once for each. */
typedef struct MshElement {
    int dim, nodes[MSH_MAX_NODES], count;
    long entity, physical; /* the last one of those it was written for */
    int first, end;        /* faces or cells that it became            */
} MshElement;

typedef struct Msh {
    Scan *scan;
    MeshReader *reader;
    bool new_format, element_section; /* 4.1; it has begun                                        */
    int curved_type, curved_line;     /* of the first edge or face of second order; line 0: there is none */
    MshNode *nodes;                   /* [vertex_count] sorted by tag                              */
    MshPhysical *names;
    MshEntity *entities;
    int name_count, entity_count;
    size_t entity_room;
    MshElement *elements; /* the faces and cells of 2.2 */
    Lookup element_lookup;
    int element_count;
    size_t element_room;
} Msh;

static const long MSH_LARGEST = 9007199254740991; /* of a tag */

static inline bool msh_integer(Msh *msh, const char *what, long low, long high, long *value)
{
    return scan_integer(msh->scan, what, low, high, value);
}

static inline bool msh_line(Msh *msh, const char *section)
{
    return scan_line(msh->scan) || scan_refuse(msh->scan, "the file ends within %s", section);
}

/* The reader's group of a physical one. */
int msh_group(Msh *msh, int dim, long physical);

/* The physical groups of an entity of 4.1: the number of them, from *first on. */
int msh_entity_groups(const Msh *msh, int dim, long tag, int *first);

/* The next numbers of the line as nodes: their vertices. */
bool msh_vertices(Msh *msh, int count, int *vertices);

/* The section of elements. */
bool msh_read_elements(Msh *msh);

/* When all is read: edges and faces of second order belong to tetrahedra. */
bool msh_check_order(Msh *msh);
