/* The field tables of drawings. */
#include "spline/front/scene.h"
#include "model/scene_tables.h"

static const YamlTable tone_table = {
    .name = "tone",
    .size = sizeof(ToneScene),
    .doc = "From grey levels (0 black, 1 white) to the part of the paper that ink covers.",
    .fields = (const YamlField[]){
        {YAML_VECTOR(ToneScene, crop), .range = "[0, 1]", .fallback = "[0, 0, 1, 1]",
         .doc = "left, top, right and bottom of what is drawn, in parts of the picture"},
        {YAML_CHOICE(ToneScene, fit), .choices = YAML_NAMES("contain", "cover"), .fallback = "contain",
         .doc = "all of it, centred on the page, and nothing drawn beside it; or the page filled and the "
                "rest lost"},
        {YAML_BOOL(ToneScene, invert),
         .doc = "white is drawn: for light pens on dark paper, with `separation: tones` too"},
        {YAML_NUMBER(ToneScene, black), .when = "!curve", .range = "[0, 1]", .fallback = "0",
         .doc = "grey level that becomes black, and all that is darker"},
        {YAML_NUMBER(ToneScene, white), .when = "!curve", .range = "[0, 1]", .fallback = "1",
         .doc = "grey level that stays blank, and all that is lighter"},
        {YAML_NUMBER(ToneScene, gamma), .when = "!curve", .range = "[0.05, 20]", .fallback = "1",
         .doc = "above 1 lightens the middle tones, below it darkens them"},
        {YAML_ROWS(ToneScene, curve), .range = "[0, 1]", .min_count = 2,
         .doc = "instead of black, white and gamma: rows of grey level and brightness, linear between"},
        {YAML_NUMBER(ToneScene, density), .range = "(0, 1)", .fallback = "0.85",
         .doc = "part of the paper covered where the picture is black; with `separation: match` what each "
                "pen covers at "
                "most"},
        {0}}};

static const YamlTable paper_table = {
    .name = "size of a page",
    .size = sizeof(PaperScene),
    .doc = "A paper.",
    .fields = (const YamlField[]){
        {YAML_NUMBERS(PaperScene, sides), .unit = "m", .range = "[0.001, 10]", .one_of = 1, .required = true,
         .short_form = true, .min_count = 2, .max_count = 2, .doc = "width and height"},
        {YAML_TEXT(PaperScene, name), .one_of = 1, .required = true, .short_form = true,
         .doc = "a0 .. a6, letter, legal or tabloid, `landscape` behind it or not; or `210x297mm`"},
        {0}}};

static const YamlTable page_table = {
    .name = "page",
    .size = sizeof(PageScene),
    .doc = "What is drawn on.",
    .fields = (const YamlField[]){
        {YAML_TABLE(PageScene, size, &paper_table), .fallback = "a4", .doc = "of the paper"},
        {YAML_NUMBER(PageScene, margin), .unit = "m", .range = "[0, 10]", .fallback = "10 mm",
         .doc = "blank all around"},
        {0}}};

static const YamlTable pen_table = {
    .name = "pens",
    .size = sizeof(PenScene),
    .doc = "One of several pens; each draws a layer of its own.",
    .fields = (const YamlField[]){
        {YAML_TEXT(PenScene, name), .required = true, .short_form = true,
         .doc = "of its layer; with `separation: cmyk` cyan, magenta, yellow or black"},
        {YAML_TEXT(PenScene, color),
         .doc = "#rrggbb, or black, grey, red, green, blue, cyan, magenta, yellow, orange, brown, purple; "
                "the pen's name if absent"},
        {YAML_BOOL(PenScene, opaque),
         .doc =
             "its ink covers what is below it, as paint markers and gel pens do; else that shines through, "
             "and `color` is what it looks like on white paper"},
        {YAML_NUMBER(PenScene, width), .unit = "m", .range = "(0, 0.1]", .doc = "`pen` if absent"},
        {YAML_NUMBER(PenScene, from), .when = "/spline.separation.kind: tones", .range = "[0, 1)",
         .doc = "with `separation: tones`: it draws where the density is this or more, up to the next pen's; "
                "0 for the first"},
        {YAML_NUMBER(PenScene, turn), .unit = "rad",
         .doc = "its strokes are turned by this angle from the direction; 0 if absent, with cmyk -30, 30, 90 "
                "and 0 deg, with match 180 deg over their number from each to the next"},
        {0}}};

static const YamlTable separation_table = {
    .name = "separation",
    .size = sizeof(SeparationScene),
    .doc = "What each pen draws.",
    .fields = (const YamlField[]){
        {YAML_CHOICE(SeparationScene, kind), .choices = YAML_NAMES("cmyk", "tones", "match"),
         .required = true, .short_form = true,
         .doc = "inks that give the picture's colours; or each pen its own range of tones; or as much of "
                "each pen as "
                "gives the picture's colours with the pens and the paper that there are"},
        {YAML_NUMBER(SeparationScene, black), .when = "kind: cmyk", .range = "[0, 1]", .fallback = "1",
         .doc = "of cmyk: how much of what cyan, magenta and yellow have in common becomes black"},
        {YAML_CHOICE(SeparationScene, intent), .when = "kind: match",
         .choices = YAML_NAMES("relative", "absolute"), .fallback = "relative",
         .doc = "of match: the picture's white and black become the nearest colours to them that pens and "
                "paper have, "
                "and all between them goes along; or every colour becomes the nearest one, and beyond all of "
                "them "
                "there is no difference"},
        {0}}};

static const YamlTable cross_table = {
    .name = "cross",
    .size = sizeof(CrossScene),
    .doc = "Sets of strokes that cross each other, each with its share of the tone.",
    .fields = (const YamlField[]){
        {YAML_NUMBER(CrossScene, angle), .unit = "rad", .fallback = "90 deg",
         .doc = "from one set to the next"},
        {YAML_NUMBERS(CrossScene, from), .range = "[0, 1)", .required = true, .min_count = 2, .max_count = 8,
         .doc =
             "density from which each set draws, growing: [0, 0.35] crosses in the dark parts only, [0, 0] "
             "everywhere"},
        {0}}};

static const YamlTable contours_table = {
    .name = "contours",
    .size = sizeof(ContoursScene),
    .doc = "Strokes along edges or lines of equal tone of the picture, or outlines of regions. They stay "
           "where they are, are a layer "
           "of their "
           "own, `contours`, behind those of the pens, and the tone counts their ink: hatching keeps away "
           "from them.",
    .fields = (const YamlField[]){
        {YAML_CHOICE(ContoursScene, kind), .choices = YAML_NAMES("edges", "outlines"), .one_of = 1,
         .required = true, .short_form = true,
         .doc = "edges: where the density changes most, across the way that it does; outlines: of each of "
                "the `regions`, within it"},
        {YAML_NUMBERS(ContoursScene, levels), .range = "(0, 1)", .one_of = 1, .required = true,
         .min_count = 1, .max_count = 32,
         .doc = "where the density, the part of the paper to be covered, is this"},
        {YAML_NUMBER(ContoursScene, contrast), .when = "kind: edges", .range = "(0, 1]", .fallback = "0.1",
         .doc = "of edges: at least so high a step of the density somewhere along them, and half of it "
                "everywhere"},
        {YAML_NUMBER(ContoursScene, detail), .unit = "m", .range = "(0, 1]",
         .doc = "edges and levels are those of the density blurred by a Gaussian of this deviation, outlines "
                "those of the distance to them; if absent that of the direction, of outlines half a pen"},
        {YAML_NUMBER(ContoursScene, shortest), .unit = "m", .range = "[0, 10]",
         .doc = "lines that are shorter are left out; 10 widths if absent"},
        {YAML_NUMBER(ContoursScene, width), .unit = "m", .range = "(0, 0.1]", .doc = "`pen` if absent"},
        {YAML_TEXT(ContoursScene, color), .doc = "as of `pens`; black if absent"},
        {YAML_BOOL(ContoursScene, opaque), .doc = "as of `pens`: light ones on dark paper are"},
        {0}}};

static const YamlTable direction_table = {
    .name = "direction",
    .size = sizeof(DirectionScene),
    .doc = "Which way strokes run.",
    .fields = (const YamlField[]){
        {YAML_CHOICE(DirectionScene, image), .choices = YAML_NAMES("structure_tensor"), .one_of = 1,
         .short_form = true, .required = true, .doc = "along the edges and equal tones of the picture"},
        {YAML_NUMBER(DirectionScene, angle), .unit = "rad", .one_of = 1, .required = true, .short_form = true,
         .doc = "everywhere the same, clockwise from the horizontal"},
        {YAML_TEXTS(DirectionScene, formula), .one_of = 1, .required = true, .min_count = 2, .max_count = 2,
         .doc = "two expressions of x, y (m from the drawable part's top left corner, y down) and u, v (the "
                "same in "
                "parts of its sides): a vector along the strokes, (0, 0) where any direction will do"},
        {YAML_FILE(DirectionScene, file), .one_of = 1, .required = true,
         .doc =
             "a picture stretched over the page: grey is the angle, black 0 to white 180 deg; of a coloured "
             "one 2R - 1, 2G - 1 is the vector"},
        {YAML_NUMBER(DirectionScene, turn), .unit = "rad", .fallback = "0", .doc = "turns all of it"},
        {YAML_NUMBER(DirectionScene, detail), .when = "image", .unit = "m", .range = "(0, 1]",
         .doc = "of the structure tensor: blur before the gradient; about a pen's width if absent, 0.004 of "
                "the page at least"},
        {YAML_NUMBER(DirectionScene, smooth), .when = "image", .unit = "m", .range = "(0, 1]",
         .doc = "and over the tensor; about 3 widths"},
        {YAML_NUMBER(DirectionScene, spread), .when = "image", .unit = "m", .range = "(0, 10]",
         .doc =
             "distance over which sure directions bend towards each other; about 5 widths, more is calmer"},
        WHERE_ROW(DirectionScene),
        {0}}};

static const YamlTable region_table = {
    .name = "regions",
    .size = sizeof(RegionScene),
    .doc = "A part of the page. The middle of each stroke stays within its outline, to a sixth of a pen at "
           "corners "
           "(docs/line_art.md). What several share belongs to the first of them.",
    .fields = (const YamlField[]){
        {YAML_FILE(RegionScene, svg), .one_of = 1, .required = true,
         .doc =
             "an SVG drawing: what is inside an odd number of its closed shapes (an open one ends where it "
             "began), whatever their colours are"},
        {YAML_FILE(RegionScene, mask), .one_of = 1, .required = true,
         .doc =
             "a picture, PNG, JPEG, PGM or PPM: what is lighter than middle grey. It lies on the page as the "
             "scene's picture does, with `tone.crop` and `tone.fit`, or whole where there is none"},
        {YAML_CHOICE(RegionScene, fit), .when = "svg", .choices = YAML_NAMES("contain", "paper"),
         .fallback = "contain",
         .doc =
             "its shapes as large as the drawable part has room for, centred; or in their own size from the "
             "paper's top left corner"},
        {YAML_BOOL(RegionScene, invert), .doc = "what is outside, or darker"},
        {YAML_OPTIONAL(RegionScene, direction, &direction_table),
         .doc = "of its strokes; the drawing's if absent"},
        {YAML_TEXT(RegionScene, pen), .when = "!/spline.separation {all of its pens draw in each region}",
         .doc = "the name of the one of `pens` that draws it; without `separation` each region has one"},
        {0}}};

static const YamlTable strokes_table = {
    .name = "start of a drawing",
    .size = sizeof(StrokesScene),
    .doc = "The strokes that a relaxation starts from.",
    .fields = (const YamlField[]){
        {YAML_CHOICE(StrokesScene, kind), .choices = YAML_NAMES("streamlines", "random"), .one_of = 1,
         .required = true, .short_form = true,
         .doc = "evenly spaced along the directions, or through random places, more where it is dark"},
        {YAML_FILE(StrokesScene, file), .one_of = 1, .required = true,
         .doc =
             "strokes that there are, where they lie on their paper: a result (.vtkhdf), with its pens by "
             "their "
             "numbers; or, for one pen, the lines of an .svg file, which become segments of the rest length"},
        {YAML_NUMBER(StrokesScene, separation), .when = "kind: streamlines", .range = "[0.2, 5]",
         .doc = "of streamlines, in units of pen/density; about 0.86 if absent"},
        {YAML_NUMBER(StrokesScene, ink), .when = "kind", .range = "[0, 10]", .fallback = "1",
         .doc = "length of all strokes, of that which gives the tone; 0: streamlines take the separation as "
                "it is"},
        {YAML_NUMBER(StrokesScene, longest), .when = "kind: streamlines", .unit = "m", .range = "(0, 100]",
         .doc = "of a streamline; as long as it will be if absent"},
        {YAML_INTEGER(StrokesScene, segments), .range = "[1, 1000]", .fallback = "8",
         .doc = "of a random stroke, and of one that a round puts in"},
        {0}}};

#define ENERGY(m, d, what)                                                                                   \
    {                                                                                                        \
        YAML_NUMBER(SplineWeights, m), .range = "[0, inf)", .fallback = d, .doc = what                       \
    }
static const YamlTable energies_table = {
    .name = "energies",
    .size = sizeof(SplineWeights),
    .doc =
        "How much each energy counts, per length of ink: pure numbers that mean the same on every page and "
        "with every pen; 0 switches one off. docs/line_art.md has the formulas.",
    .fields = (const YamlField[]){
        ENERGY(tone, "1", "the ink around each place is what the picture asks for"),
        ENERGY(strain, "0.5", "segments keep their length, and an even speed along it"),
        ENERGY(bend, "0.1", "strokes are smooth"),
        ENERGY(align, "0.5", "strokes run along the direction"),
        ENERGY(wall, "0.1", "strokes stay on the page"),
        {YAML_NUMBER(SplineWeights, outline), .when = "/spline.regions", .range = "(0, inf)",
         .fallback = "0.1", .doc = "strokes stay within the outline of their region"},
        ENERGY(stretch, "0", "[Linewise], strain: length of each segment"),
        ENERGY(curvature, "0", "[Linewise], bending: curvature squared"),
        ENERGY(potential, "0", "[Linewise]: strokes go where `potential` is low"),
        ENERGY(flow, "0", "[Linewise], field: strokes run against `flow`, and are long"),
        ENERGY(boundary, "0", "[Linewise]: away from the page's edges"),
        ENERGY(pair, "0", "[Linewise], corrected: strokes keep away from each other"),
        ENERGY(length, "0",
               "[Linewise], strain as printed: length of each stroke; its segments are not held"),
        {0}}};

#define FIELD_TABLE_OF(id, n, what, r)                                                                       \
    static const YamlTable id##_table = {                                                                    \
        .name = n,                                                                                           \
        .size = sizeof(FieldScene),                                                                          \
        .doc = what,                                                                                         \
        .fields = (const YamlField[]){                                                                       \
            {YAML_TEXT(FieldScene, formula), .required = true, .short_form = true,                           \
             .doc = "an expression of x, y (m from the drawable part's top left corner, y down) and u, v "   \
                    "(the same in parts of its sides)" r},                                                   \
            WHERE_ROW(FieldScene),                                                                           \
            {0}}}
FIELD_TABLE_OF(field_density, "density of a drawing", "A density without a picture.",
               "; below 0 counts as 0, above 1 as 1");
FIELD_TABLE_OF(potential, "potential", "Of the energy potential.", "");

static const YamlTable flow_table = {
    .name = "flow",
    .size = sizeof(FlowScene),
    .doc = "Of the energy flow.",
    .fields = (const YamlField[]){{YAML_TEXTS(FlowScene, formula), .required = true, .short_form = true,
                                   .min_count = 2, .max_count = 2,
                                   .doc = "two expressions as of `direction`: a vector"},
                                  WHERE_ROW(FlowScene),
                                  {0}}};

static const YamlTable pair_table = {
    .name = "pair",
    .size = sizeof(PairScene),
    .doc = "Of the energy pair.",
    .fields = (const YamlField[]){
        {YAML_CHOICE(PairScene, kernel), .choices = YAML_NAMES("wendland", "triweight", "coulomb"),
         .fallback = "wendland",
         .doc = "how it falls off; coulomb is [Linewise]'s 1/d as printed: between different "
                "strokes only, with no end"},
        {YAML_NUMBER(PairScene, radius), .range = "[0.1, 20]", .fallback = "1.6",
         .doc = "where it is 0 (of coulomb 1), in mean distances of lines"},
        {0}}};

static const YamlTable monte_carlo_table = {
    .name = "monte_carlo",
    .size = sizeof(MonteCarloScene),
    .doc = "Of method: monte_carlo. Temperatures are energies per length of ink times distance of lines.",
    .fields = (const YamlField[]){
        {YAML_INTEGER(MonteCarloScene, temperatures), .range = "[1, 100000]", .fallback = "20",
         .doc = "how many, falling geometrically"},
        {YAML_INTEGER(MonteCarloScene, sweeps), .range = "[1, 100000]", .fallback = "50",
         .doc = "at each: so many tries per stroke"},
        {YAML_NUMBER(MonteCarloScene, first), .range = "(0, inf)", .fallback = "0.03", .doc = "the highest"},
        {YAML_NUMBER(MonteCarloScene, last), .range = "(0, inf)", .fallback = "3.0e-4", .doc = "the lowest"},
        {0}}};

static const YamlTable dynamics_table = {
    .name = "dynamics",
    .size = sizeof(DynamicsScene),
    .doc = "Of method: dynamics. Lengths and times are in mean distances of lines.",
    .fields = (const YamlField[]){
        {YAML_NUMBER(DynamicsScene, step), .range = "(0, inf)", .fallback = "1", .doc = "of implicit Euler"},
        {YAML_INTEGER(DynamicsScene, steps), .range = "[1, 1000000]", .fallback = "100", .doc = "how many"},
        {YAML_NUMBER(DynamicsScene, damping), .range = "[0, inf)", .fallback = "0.1",
         .doc = "part of the velocity lost in a time of 1"},
        {0}}};

static const YamlTable z_axis_table = {
    .name = "z_axis",
    .size = sizeof(ZAxisScene),
    .doc = "Of a plotter whose pen is on a z axis, for `output.gcode`.",
    .fields =
        (const YamlField[]){{YAML_NUMBER(ZAxisScene, up), .unit = "m", .range = "[-0.1, 0.1]",
                             .fallback = "5 mm", .doc = "z of the lifted pen"},
                            {YAML_NUMBER(ZAxisScene, down), .unit = "m", .range = "[-0.1, 0.1]",
                             .fallback = "0 mm", .doc = "z of the pen on the paper"},
                            {YAML_NUMBER(ZAxisScene, speed), .unit = "m/s", .range = "[1.0e-5, 10]",
                             .fallback = "10 mm/s", .doc = "at most; where `lift` is longer, it goes slower"},
                            {0}}};

static const YamlTable servo_table = {
    .name = "servo",
    .size = sizeof(ServoScene),
    .doc = "Of a plotter whose pen is on a servo, for `output.gcode_servo`. After each command it waits for "
           "half of `lift` (G4).",
    .fields = (const YamlField[]){
        {YAML_TEXT(ServoScene, up), .fallback = "M5",
         .doc = "the command that lifts the pen, as M3 S90 or M280 P0 S90: up to 60 "
                "letters, digits, spaces and . - + _ ="},
        {YAML_TEXT(ServoScene, down), .fallback = "M3 S30", .doc = "the command that lowers it"},
        {YAML_CHOICE(ServoScene, pause), .choices = YAML_NAMES("seconds", "milliseconds"),
         .fallback = "seconds",
         .doc = "what G4 P counts: seconds (GRBL, LinuxCNC) or milliseconds "
                "(Marlin)"},
        {0}}};

static const YamlTable plotter_table = {
    .name = "plotter",
    .size = sizeof(PlotterScene),
    .doc =
        "How fast the plotter is and how it lifts its pen, for its files and the time that plotting takes. "
        "HPGL files have the speed `down` in whole cm/s (VS); such a plotter lifts the pen as it can.",
    .fields = (const YamlField[]){
        {YAML_NUMBER(PlotterScene, down), .unit = "m/s", .range = "[1.0e-5, 10]", .fallback = "40 mm/s",
         .doc = "with the pen on the paper"},
        {YAML_NUMBER(PlotterScene, up), .unit = "m/s", .range = "[1.0e-5, 10]", .fallback = "100 mm/s",
         .doc = "with the pen lifted"},
        {YAML_NUMBER(PlotterScene, lift), .unit = "s", .range = "[0, 60]", .fallback = "0.3 s",
         .doc = "to lift and to lower it, together; a z axis takes longer where its "
                "speed asks for that"},
        {YAML_NUMBER(PlotterScene, at_most), .unit = "s", .range = "[1, 1.0e+7]",
         .doc = "the time that plotting may take: where the picture takes longer, all of it is drawn "
                "lighter, by one factor that "
                "`check` and `run` say; at least a tenth of its ink stays. No end if absent"},
        {YAML_OPTIONAL(PlotterScene, z, &z_axis_table), .doc = "of a pen on a z axis"},
        {YAML_OPTIONAL(PlotterScene, servo, &servo_table), .doc = "of a pen on a servo"},
        {YAML_FILE(PlotterScene, profile), .doc = "a machine's own words (docs/line_art.md, "
                                                  "scenes/plotters), for `output.plotter`; the result keeps "
                                                  "them for `export --plotter profile`"},
        {0}}};

const YamlTable spline_table = {
    .name = "spline",
    .size = sizeof(SplineScene),
    .doc = "A drawing: strokes, cubic splines, that relax until their ink has the tones of a picture.",
    .fields = (const YamlField[]){
        {YAML_FILE(SplineScene, image), .one_of = 1, .required = true,
         .doc = "the picture: PNG, JPEG, PGM or PPM of at most 400 million pixels, turned upright as its "
                "Exif tag "
                "says"},
        {YAML_OPTIONAL(SplineScene, density, &field_density_table), .one_of = 1, .required = true,
         .doc = "no picture, but the part of the paper that ink covers"},
        {YAML_TABLE(SplineScene, tone, &tone_table), .when = "image", .fallback = "{}",
         .doc = "of a picture"},
        {YAML_TABLE(SplineScene, page, &page_table), .fallback = "{}", .doc = "paper and margin"},
        {YAML_NUMBER(SplineScene, pen), .unit = "m", .range = "(0, 0.1]", .fallback = "0.5 mm",
         .doc = "width of the line"},
        {YAML_LIST(SplineScene, pens, &pen_table), .max_count = 32,
         .doc = "several of them; one black pen if absent"},
        {YAML_TEXT(SplineScene, paper),
         .doc = "its colour, as a pen's; white if absent. Light pens on dark paper are `opaque`"},
        {YAML_OPTIONAL(SplineScene, separation, &separation_table), .doc = "of several pens"},
        {YAML_LIST(SplineScene, regions, &region_table), .max_count = 64,
         .doc = "what is drawn of the page, each with strokes of its own; all of it if absent"},
        {YAML_OPTIONAL(SplineScene, cross, &cross_table), .doc = "crossed strokes, of each pen"},
        {YAML_OPTIONAL(SplineScene, contours, &contours_table), .doc = "lines around things"},
        {YAML_TABLE(SplineScene, direction, &direction_table), .fallback = "structure_tensor",
         .doc = "of the strokes"},
        {YAML_TABLE(SplineScene, start, &strokes_table), .fallback = "streamlines",
         .doc = "where a relaxation starts"},
        {YAML_TABLE(SplineScene, energies, &energies_table), .fallback = "{}", .doc = "what it minimises"},
        {YAML_OPTIONAL(SplineScene, potential, &potential_table), .when = "energies.potential",
         .doc = "of the energy potential; the brightness if absent"},
        {YAML_OPTIONAL(SplineScene, flow, &flow_table), .when = "energies.flow", .doc = "of the energy flow"},
        {YAML_TABLE(SplineScene, pair, &pair_table), .when = "energies.pair", .fallback = "{}",
         .doc = "of the energy pair"},
        {YAML_CHOICE(SplineScene, method),
         .choices = YAML_NAMES("auto", "newton", "gradient", "monte_carlo", "dynamics"), .fallback = "auto",
         .doc = "auto is the best one; the others are there to compare with (docs/line_art.md)"},
        {YAML_INTEGER(SplineScene, iterations), .when = "method: auto, newton, gradient",
         .range = "[0, 1000000]", .fallback = "500",
         .doc = "of auto, newton and gradient, in each round, at most"},
        {YAML_NUMBER(SplineScene, tolerance), .when = "method: auto, newton, gradient", .range = "[0, 1)",
         .fallback = "3.0e-3", .doc = "settled when the energy fell by less than this part in 20 iterations"},
        {YAML_BOOL(SplineScene, draft), .when = "method: auto",
         .doc = "a first look, in about 2 s up to 20 000 segments: no rounds, and no more iterations than "
                "there is time for"},
        {YAML_INTEGER(SplineScene, rounds), .range = "[0, 1000]", .fallback = "2",
         .doc = "after the first relaxation: strokes come and go where that helps, then all relax again"},
        {YAML_NUMBER(SplineScene, rest), .range = "[0, 10]", .fallback = "1.2",
         .doc = "rest length of a segment in mean distances of lines, 0.05 at least; 0: its length at the "
                "start"},
        {YAML_TABLE(SplineScene, monte_carlo, &monte_carlo_table), .when = "method: monte_carlo",
         .fallback = "{}", .doc = "of that method"},
        {YAML_TABLE(SplineScene, dynamics, &dynamics_table), .when = "method: dynamics", .fallback = "{}",
         .doc = "of that method"},
        {YAML_INTEGER(SplineScene, seed), .range = "[0, 2147483647]", .fallback = "1",
         .doc = "of everything random: the same seed gives the same drawing, byte by byte"},
        {YAML_CHOICE(SplineScene, order), .choices = YAML_NAMES("shortest", "as_made"),
         .fallback = "shortest",
         .doc = "of the strokes on the plotter: little way for the lifted pen, ends that meet joined; or as "
                "they come"},
        {YAML_TABLE(SplineScene, plotter, &plotter_table), .fallback = "{}",
         .doc = "its speeds, and how it lifts the pen"},
        {0}}};

const SplineScene *spline_scene(const Scene *scene)
{
    return scene_of(scene, &spline_body);
}
