#include "io/paper.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

typedef struct Paper {
    const char *name;
    double width, height; /* m */
} Paper;

static const Paper papers[] = {{"a0", 0.841, 1.189},       {"a1", 0.594, 0.841},     {"a2", 0.420, 0.594},
                               {"a3", 0.297, 0.420},       {"a4", 0.210, 0.297},     {"a5", 0.148, 0.210},
                               {"a6", 0.105, 0.148},       {"letter", .2159, .2794}, {"legal", .2159, .3556},
                               {"tabloid", 0.2794, 0.4318}};

static bool named_size(const char *word, double size[2])
{
    for (size_t k = 0; k < sizeof papers / sizeof *papers; k++) {
        if (strcasecmp(word, papers[k].name) != 0) continue;
        size[0] = papers[k].width;
        size[1] = papers[k].height;
        return true;
    }
    return false;
}

/* "210x297mm" */
static bool measured_size(const char *word, double size[2])
{
    static const char *const units[] = {"mm", "cm", "in", "m"};
    static const double metres[] = {1e-3, 1e-2, 0.0254, 1};
    char unit[3];
    int end = 0;
    if (sscanf(word, "%lfx%lf%2[a-zA-Z]%n", &size[0], &size[1], unit, &end) != 3 || word[end]) return false;
    for (int k = 0; k < 4; k++) {
        if (strcasecmp(unit, units[k]) != 0) continue;
        size[0] *= metres[k];
        size[1] *= metres[k];
        return size[0] >= 1e-3 && size[0] <= 10 && size[1] >= 1e-3 && size[1] <= 10;
    }
    return false;
}

static bool turn(const char *word, double size[2])
{
    bool landscape = !strcasecmp(word, "landscape");
    double shorter = fmin(size[0], size[1]), longer = fmax(size[0], size[1]);
    size[0] = landscape ? longer : shorter;
    size[1] = landscape ? shorter : longer;
    return landscape || !strcasecmp(word, "portrait");
}

bool paper_size(const char *text, double size[2], Error *err)
{
    char word[3][32] = {"", "", ""};
    int words = sscanf(text, "%31s %31s %31s", word[0], word[1], word[2]);
    bool known = words >= 1 && words <= 2 && (named_size(word[0], size) || measured_size(word[0], size)) &&
                 (words == 1 || turn(word[1], size));
    return known || error_set(err,
                              "\"%s\" is no size of paper; say a0 to a6, letter, legal, tabloid or a size as "
                              "210x297mm (1 mm to 10 m), and landscape behind it for one on its side",
                              text);
}
