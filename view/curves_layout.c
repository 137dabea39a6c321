#include "view/curves_layout.h"
#include "view/page.h"
#include <math.h>

/* Points. The views and what is below them are at most HIGHEST high. */
static const double HIGHEST = 560, CHART_HEIGHT = 150, CHART_LOWEST = 115, CHART_HIGHEST = 280,
                    CHART_WIDTH = 215;
static const double BESIDE_GAP = 26;
static const double GAIN = 1.1; /* another arrangement must make the curves larger by this much */

enum { CHARTS_IN_ROW = 2 }; /* more are one above the other */

/* In which column and row each view is. */
typedef struct Grid {
    int columns, rows;
    struct {
        int column, row;
    } cell[CURVES_VIEWS_MAX];
} Grid;

static const Grid single = {1, 1, {{0, 0}}}, in_row = {3, 1, {{0, 0}, {1, 0}, {2, 0}}},
                  in_column = {1, 3, {{0, 0}, {0, 1}, {0, 2}}}, top_above = {2, 2, {{0, 1}, {1, 1}, {0, 0}}};

/* The corner is the free one beside the top view. */
typedef enum ChartPlace { CHARTS_BELOW, CHARTS_BESIDE, CHARTS_CORNER, CHARTS_PLACES } ChartPlace;

/* One way to arrange a page. Extents in m are those of the widest or highest view of a column or row. */
typedef struct Plan {
    const Grid *grid;
    ChartPlace place;
    double widths[CURVES_VIEWS_MAX], heights[CURVES_VIEWS_MAX];
    double width, height; /* sums of them */
    double scale;         /* pt per metre */
} Plan;

/* Room beside the boxes: margins and gaps, pt. */
static double spare_width(const Plan *plan, CurvesMargins margins)
{
    return plan->grid->columns * margins.left + (plan->grid->columns - 1) * PAGE_GAP;
}

static double spare_height(const Plan *plan, CurvesMargins margins)
{
    return plan->grid->rows * (margins.above + margins.below) + (plan->grid->rows - 1) * PAGE_GAP;
}

/* What the views may take of the page's width. */
static double room_width(const CurvesScene *scene, ChartPlace place)
{
    bool beside = scene->chart_count > 0 && place == CHARTS_BESIDE;
    return PAGE_WIDTH - 2 * PAGE_MARGIN - (beside ? CHART_WIDTH + BESIDE_GAP : 0);
}

/* Height of the views with their margins, pt. */
static double figure_height(const Plan *plan, CurvesMargins margins)
{
    return plan->scale * plan->height + spare_height(plan, margins);
}

/* Where the charts go that are not below: right of the views, or of the top one. */
static Box chart_room(const Plan *plan, CurvesMargins margins, double left, double top)
{
    bool corner = plan->place == CHARTS_CORNER;
    double views = corner ? margins.left + plan->scale * plan->widths[0]
                          : plan->scale * plan->width + spare_width(plan, margins);
    double x = left + views + BESIDE_GAP;
    double height = corner ? plan->scale * plan->heights[0] + margins.above + margins.below
                           : figure_height(plan, margins);
    return (Box){x, top, PAGE_WIDTH - PAGE_MARGIN - x, height};
}

/* Charts beside the views want as much room as below them; the corner may be a little smaller. */
static bool charts_fit(const CurvesScene *scene, const Plan *plan, CurvesMargins margins)
{
    if (scene->chart_count == 0 || plan->place == CHARTS_BELOW) return true;
    Box room = chart_room(plan, margins, PAGE_MARGIN, 0);
    if (plan->place == CHARTS_CORNER && plan->grid != &top_above) return false;
    return room.width >= CHART_WIDTH - 1 &&
           room.height >= scene->chart_count * (plan->place == CHARTS_CORNER ? CHART_LOWEST : CHART_HEIGHT);
}

static Plan make_plan(const CurvesScene *scene, const CurvesLayout *layout, const Grid *grid,
                      ChartPlace place)
{
    Plan plan = {.grid = grid, .place = place};
    CurvesMargins margins = curves_view_margins(&layout->views[0]);
    for (int v = 0; v < layout->view_count; v++) {
        const CurvesView *view = &layout->views[v];
        int column = grid->cell[v].column, row = grid->cell[v].row;
        plan.widths[column] = fmax(plan.widths[column], view->high[0] - view->low[0]);
        plan.heights[row] = fmax(plan.heights[row], view->high[1] - view->low[1]);
    }
    for (int k = 0; k < CURVES_VIEWS_MAX; k++) plan.width += plan.widths[k], plan.height += plan.heights[k];
    bool below = scene->chart_count > 0 && place == CHARTS_BELOW;
    double width = room_width(scene, place) - spare_width(&plan, margins),
           height = HIGHEST - spare_height(&plan, margins) - (below ? CHART_HEIGHT + PAGE_GAP : 0);
    plan.scale = fmin(width / plan.width, height / plan.height);
    if (!charts_fit(scene, &plan, margins)) plan.scale = 0;
    return plan;
}

/* The first plan, unless another one shows the curves larger. */
static Plan best_plan(const CurvesScene *scene, const CurvesLayout *layout)
{
    const Grid *const three[] = {&in_row, &top_above, &in_column};
    Plan best = {.scale = 0};
    int grids = layout->view_count == 1 ? 1 : 3, places = scene->chart_count > 0 ? CHARTS_PLACES : 1;
    for (int g = 0; g < grids; g++)
        for (int p = 0; p < places; p++) {
            Plan plan = make_plan(scene, layout, layout->view_count == 1 ? &single : three[g], (ChartPlace)p);
            if (plan.scale > best.scale * (best.scale > 0 ? GAIN : 1)) best = plan;
        }
    return best;
}

/* Shows more to the left and right of a view, or above and below it. */
static void stretch(CurvesView *view, int k, double extent)
{
    double more = 0.5 * (extent - (view->high[k] - view->low[k]));
    view->low[k] -= more;
    view->high[k] += more;
}

/* What is left of the width widens the columns, unless they become wider than high, or leave too little for a
 * chart in the corner; charts beside take it themselves. Returns the views' left end. */
static double widen_columns(const CurvesScene *scene, Plan *plan, CurvesMargins margins)
{
    if (scene->chart_count > 0 && plan->place == CHARTS_BESIDE) return PAGE_MARGIN;
    double room = room_width(scene, plan->place) - spare_width(plan, margins);
    for (int c = 0; c < plan->grid->columns; c++) {
        double left_over = room - plan->scale * plan->width;
        double more =
            fmin(left_over / (plan->grid->columns - c), plan->scale * (plan->height - plan->widths[c]));
        if (scene->chart_count > 0 && plan->place == CHARTS_CORNER && c == 0)
            more = fmin(more, chart_room(plan, margins, PAGE_MARGIN, 0).width - CHART_WIDTH);
        plan->widths[c] += fmax(more, 0) / plan->scale;
        plan->width += fmax(more, 0) / plan->scale;
    }
    return PAGE_MARGIN + 0.5 * (room - plan->scale * plan->width);
}

static void place_views(CurvesLayout *layout, const Plan *plan, double left, double top)
{
    CurvesMargins margins = curves_view_margins(&layout->views[0]);
    for (int v = 0; v < layout->view_count; v++) {
        CurvesView *view = &layout->views[v];
        double x = left + margins.left, y = top + margins.above;
        int column = plan->grid->cell[v].column, row = plan->grid->cell[v].row;
        for (int c = 0; c < column; c++) x += plan->scale * plan->widths[c] + margins.left + PAGE_GAP;
        for (int r = 0; r < row; r++)
            y += plan->scale * plan->heights[r] + margins.above + margins.below + PAGE_GAP;
        stretch(view, 0, plan->widths[column]);
        view->scale = plan->scale;
        view->box =
            (Box){x, y, plan->scale * plan->widths[column], plan->scale * (view->high[1] - view->low[1])};
    }
}

static void place_charts(const CurvesScene *scene, CurvesLayout *layout, const Plan *plan, double left,
                         double top)
{
    CurvesMargins margins = curves_view_margins(&layout->views[0]);
    int count = scene->chart_count, columns = count <= CHARTS_IN_ROW ? count : 1;
    if (plan->place == CHARTS_BELOW) {
        double width = (PAGE_WIDTH - 2 * PAGE_MARGIN - (columns - 1) * BESIDE_GAP) / columns;
        top += figure_height(plan, margins) + PAGE_GAP;
        for (int k = 0; k < count; k++)
            layout->charts[k] = (Box){PAGE_MARGIN + k % columns * (width + BESIDE_GAP),
                                      top + k / columns * (CHART_HEIGHT + PAGE_GAP), width, CHART_HEIGHT};
        layout->end = layout->charts[count - 1].y + CHART_HEIGHT;
        return;
    }
    Box room = chart_room(plan, margins, left, top);
    double pitch = fmin(room.height / count, CHART_HIGHEST);
    for (int k = 0; k < count; k++)
        layout->charts[k] =
            (Box){room.x, top + k * pitch, room.width, pitch - (k + 1 < count ? PAGE_GAP : 0)};
}

bool curves_layout(const CurvesScene *scene, double top, CurvesLayout *layout)
{
    *layout = (CurvesLayout){.view_count = 0};
    layout->view_count = curves_views(scene, layout->views);
    if (layout->view_count == 0) return false;
    Plan plan = best_plan(scene, layout);
    CurvesMargins margins = curves_view_margins(&layout->views[0]);
    double left = widen_columns(scene, &plan, margins);
    layout->end = top + figure_height(&plan, margins);
    place_views(layout, &plan, left, top);
    if (scene->chart_count > 0) place_charts(scene, layout, &plan, left, top);
    return true;
}
