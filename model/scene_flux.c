/* The field tables of flux densities, and of what moves in time. */
#include "model/scene_tables.h"

const YamlTable path_table = {
    .name = "path",
    .size = sizeof(PathScene),
    .doc = "How far something has moved (m) or turned (a rotation vector, rad) at the time t (s).",
    .fields = (const YamlField[]){{YAML_TEXTS(PathScene, formula), .one_of = 1, .required = true,
                                   .short_form = true, .min_count = 3, .max_count = 3,
                                   .doc = "three expressions of t"},
                                  {YAML_FILE(PathScene, file), .one_of = 1, .required = true,
                                   .doc = "a CSV file with rows t, x, y, z, t ascending, along half of a "
                                          "motion at least: linear between the "
                                          "rows, constant beyond them"},
                                  {0}}};

static const YamlTable dipole_table = {
    .name = "dipole",
    .size = sizeof(DipoleScene),
    .doc = "The field of a point dipole.",
    .fields = (const YamlField[]){
        {YAML_VECTOR(DipoleScene, at), .unit = "m", .required = true, .doc = "where it is"},
        {YAML_VECTOR(DipoleScene, moment), .unit = "A m^2", .required = true, .doc = "its moment"},
        {0}}};

static const YamlTable magnet_table = {
    .name = "magnet",
    .size = sizeof(MagnetScene),
    .doc =
        "The field of a permanent magnet, magnetised the same all through: of a block or a cylinder as it "
        "is, at its faces and far away, but on its edges, where it is infinite; of a volume that of a dipole "
        "remanence*volume/mu_0 at its centre, right from some of its own sizes on.",
    .fields = (const YamlField[]){
        {YAML_VECTOR(MagnetScene, at), .unit = "m", .required = true, .doc = "its centre"},
        {YAML_VECTOR(MagnetScene, remanence), .unit = "T", .required = true,
         .doc = "its remanence: direction and size of the magnetisation"},
        {YAML_VECTOR(MagnetScene, size), .unit = "m", .range = "(0, inf)", .one_of = 1, .required = true,
         .doc = "of a block: along x, y, z, before it turns"},
        {YAML_NUMBER(MagnetScene, radius), .unit = "m", .range = "(0, inf)", .one_of = 1, .required = true,
         .doc = "of a cylinder"},
        {YAML_NUMBER(MagnetScene, volume), .unit = "m^3", .range = "(0, inf)", .one_of = 1, .required = true,
         .doc = "of what is small beside its distance"},
        {YAML_NUMBER(MagnetScene, length), .when = "radius", .unit = "m", .range = "(0, inf)",
         .doc = "of a cylinder"},
        {YAML_VECTOR(MagnetScene, axis), .when = "radius", .fallback = "[0, 0, 1]",
         .doc = "of a cylinder: its direction, of any length but 0"},
        {0}}};

static const YamlTable coil_table = {
    .name = "coil",
    .size = sizeof(CoilScene),
    .doc = "The field of a current around an axis, counter-clockwise as the axis points to one; of a winding "
           "without thickness: it jumps through one that has a length, and grows without bounds at a wire "
           "and at the ends of a length.",
    .fields = (const YamlField[]){
        {YAML_VECTOR(CoilScene, at), .unit = "m", .required = true, .doc = "its centre"},
        {YAML_VECTOR(CoilScene, axis), .fallback = "[0, 0, 1]", .doc = "its direction, of any length but 0"},
        {YAML_NUMBER(CoilScene, radius), .unit = "m", .range = "(0, inf)", .one_of = 1, .required = true,
         .doc = "of a round one"},
        {YAML_VECTOR(CoilScene, size), .unit = "m", .range = "(0, inf)", .one_of = 1, .required = true,
         .doc = "of a rectangular one: its side across the axis and z (along x, if that is the axis), and "
                "the other"},
        {YAML_NUMBER(CoilScene, length), .when = "radius", .unit = "m", .range = "[0, inf)", .fallback = "0",
         .doc = "of a round one: over which the turns are spread, the same all along; 0: all in its middle"},
        {YAML_NUMBER(CoilScene, current), .unit = "A", .required = true, .doc = "in the wire"},
        {YAML_NUMBER(CoilScene, turns), .range = "(0, inf)", .fallback = "1", .doc = "of the wire"},
        {0}}};

static const YamlTable map_table = {
    .name = "map",
    .size = sizeof(FluxMapScene),
    .doc = "A field measured or computed on a regular grid; between its nodes a cubic spline. The body must "
           "stay within "
           "it.",
    .fields = (const YamlField[]){
        {YAML_FILE(FluxMapScene, file), .required = true,
         .doc =
             "a CSV file with rows x, y, z, Bx, By, Bz (m, T), one for each node, in any order; or an HDF5 "
             "file, .h5 or .hdf5, with the datasets x [nx], y [ny], z [nz] (m, ascending in equal steps) "
             "and Bx, By, Bz [nx,ny,nz] (T), whose attributes `unit` count. Along an axis with one place "
             "only the field is the same everywhere"},
        {YAML_NUMBER(FluxMapScene, scale), .fallback = "1", .doc = "factor on B: a current, for instance"},
        {0}}};

const YamlTable flux_density_table = {
    .name = "flux_density",
    .size = sizeof(FluxScene),
    .doc = "A source of the applied magnetic flux density B, which is the sum of them: a source alone, or a "
           "list. Where B "
           "varies in space, forces follow from its gradient.",
    .fields = (const YamlField[]){
        {YAML_TEXT(FluxScene, name), .doc = "of what has a place: its name; source1, source2, .. if absent"},
        {YAML_VECTOR(FluxScene, value), .unit = "T", .one_of = 1, .required = true, .short_form = true,
         .also = YAML_NAMES("uniform"), .doc = "uniform"},
        {YAML_TEXTS(FluxScene, formula), .one_of = 1, .required = true, .short_form = true, .min_count = 3,
         .max_count = 3, .doc = "three expressions, in T, of the current position x, y, z, r and the time t"},
        {YAML_FILE(FluxScene, file), .one_of = 1, .required = true,
         .doc = "a CSV file with rows t, Bx, By, Bz (s, T), t ascending, along half of a motion at least: "
                "uniform, linear "
                "between the rows, constant beyond them"},
        {YAML_OPTIONAL(FluxScene, dipole, &dipole_table), .one_of = 1, .required = true,
         .doc = "a point dipole"},
        {YAML_OPTIONAL(FluxScene, magnet, &magnet_table), .one_of = 1, .required = true,
         .doc = "a permanent magnet"},
        {YAML_OPTIONAL(FluxScene, coil, &coil_table), .one_of = 1, .required = true, .doc = "a coil"},
        {YAML_OPTIONAL(FluxScene, map, &map_table), .one_of = 1, .required = true,
         .doc = "numbers on a grid in space"},
        WHERE_ROW(FluxScene),
        {YAML_OPTIONAL(FluxScene, move, &path_table),
         .doc = "of what has a place: how far it has moved from there, m"},
        {YAML_OPTIONAL(FluxScene, turn, &path_table),
         .doc = "of what has a place: how far it has turned about its centre, a rotation vector, rad; of a "
                "formula or "
                "map about the origin"},
        {0}}};
