/* svg_tree.h - the elements of an SVG file and what its styles say of them. Private to polyline_svg.c.
 *
 * Styles are the attributes, the `style` attribute over them, and between the two the rules of <style>
 * elements whose selectors are tags, .classes and #ids in any combination, `*`, and lists of these. */
#pragma once
#include "base/error.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct SvgNode SvgNode;

/* Owned all the way down. */
struct SvgNode {
    char *name;                            /* without "svg:"; of other name spaces with their prefix       */
    char **attributes;                     /* name, value, .., NULL                                        */
    const char *id;                        /* one of them; NULL: none                                      */
    int line;                              /* in the file                                                  */
    SvgNode *parent, *first, *last, *next; /* children, and the next one of the parent's */
};

typedef struct SvgRule {
    char *selector, *declarations;
    int weight; /* the heavier rule counts, of equal ones the later */
} SvgRule;

typedef struct SvgTree {
    SvgNode *root;
    SvgNode **named; /* [named_count] elements with an id, sorted by it */
    int named_count;
    SvgRule *rules; /* those that say where something is, or whether it is shown */
    int rule_count;
    size_t rule_room;
} SvgTree;

/* False with a sentence, path:line and all, and nothing to be cleared. Refused, beside what is no XML: rules
 * with other selectors that move or hide something, and more than a thousand levels. */
bool svg_tree_parse(const char *path, const char *text, size_t length, SvgTree *tree, Error *err);
void svg_tree_clear(SvgTree *tree);

/* An attribute as it is written; NULL: absent. */
const char *svg_attribute(const SvgNode *node, const char *name);

/* An element with that id; NULL: there is none. */
const SvgNode *svg_by_id(const SvgTree *tree, const char *id);

/* What the styles say of display, visibility, transform or transform-origin; NULL: nothing. To be freed. */
char *svg_property(const SvgTree *tree, const SvgNode *node, const char *name);
