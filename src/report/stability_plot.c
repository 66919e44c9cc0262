/* stability_plot.c: heat maps of the error over half vector and roughness, and over both cosines,
 * as PNG. */
#include "report/stability_plot.h"

#include "base/error.h"
#include "check/maps.h"
#include "image/draw.h"
#include "image/label.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    CELL = 3,
    PANEL = CELL * STABILITY_MAP_SIDE,
    LEFT = 92,
    TOP = 92,
    ACROSS = PANEL + 110, /* from one panel to the next */
    DOWN = PANEL + 74,
    BAR_WIDTH = 18,
    TEXT = 6, /* height of small letters */
    MOST_PANELS = 3
};

static const float BLACK[3] = {0.0f, 0.0f, 0.0f}, GREY[3] = {0.2f, 0.2f, 0.2f};
static const double LOW = 1e-8, HIGH = 1e-2;

static void colour_of(double error, float rgb[3])
{
    render_colour_map(error > 0.0 ? log(error / LOW) / log(HIGH / LOW) : 0.0, rgb);
}

typedef struct tick {
    const char *label;
    double at; /* 0 to 1 */
} tick;

/* Cosines as their distance from the nearer end. */
static int cosine_ticks(double near, tick *ticks)
{
    static const struct {
        const char *label;
        double cosine, rest;
    } all[] = {{"1e-7", 1e-7, 1},   {"1e-5", 1e-5, 1},   {"1e-3", 1e-3, 1},
               {"0.1", 0.1, 0.9},   {"0.9", 0.9, 0.1},   {"1-1e-3", 1, 1e-3},
               {"1-1e-5", 1, 1e-5}, {"1-1e-9", 1, 1e-9}, {"1-1e-13", 1, 1e-13}};
    int count = 0;
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) {
        int crowded = near < 1e-10 && (all[k].rest == 1e-3 || all[k].rest == 1e-9);
        if (all[k].rest >= near && !crowded)
            ticks[count++] =
                (tick){all[k].label, stability_map_position(all[k].cosine, all[k].rest, near)};
    }
    return count;
}

static int alpha_ticks(tick *ticks)
{
    static const char *const labels[] = {"1e-4", "1e-3", "0.01", "0.1", "1"};
    for (int k = 0; k < 5; k++)
        ticks[k] = (tick){labels[k], k / 4.0};
    return 5;
}

static void draw_axes(render_image *image, int x, int y, stability_map_kind kind)
{
    tick ticks[16];
    int half = kind == STABILITY_MAP_HALF;
    int count = cosine_ticks(half ? STABILITY_NEAR_HALF : STABILITY_NEAR_COSINE, ticks);
    for (int k = 0; k < count; k++) {
        int at = x + (int)lround(ticks[k].at * PANEL);
        render_fill(image, at, y + PANEL, 1, 4, GREY);
        render_text_at(image, at, y + PANEL + 16, 0.5, ticks[k].label, TEXT, GREY);
    }
    render_text_at(image, x + 0.5 * PANEL, y + PANEL + 33, 0.5,
                   half ? "cos theta_h" : "cos theta_i", TEXT, BLACK);
    count = half ? alpha_ticks(ticks) : cosine_ticks(STABILITY_NEAR_COSINE, ticks);
    for (int k = 0; k < count; k++) {
        int at = y + PANEL - (int)lround(ticks[k].at * PANEL);
        render_fill(image, x - 4, at, 4, 1, GREY);
        render_text_at(image, x - 8, at + TEXT / 2, 1.0, ticks[k].label, TEXT, GREY);
    }
    render_text_at(image, x - 8, y - 10, 1.0, half ? "alpha" : "cos theta_o", TEXT, BLACK);
}

/* Without what a driver says of itself in parentheses. */
static size_t name_length(const char *title)
{
    const char *note = strstr(title, " (");
    return note ? (size_t)(note - title) : strlen(title);
}

static void draw_panel(render_image *image, int x, int y, stability_map_kind kind,
                       const char *title, float (*errors)[STABILITY_MAP_SIDE])
{
    char line[160];
    float worst = 0.0f, rgb[3];
    for (int row = 0; row < STABILITY_MAP_SIDE; row++)
        for (int column = 0; column < STABILITY_MAP_SIDE; column++) {
            colour_of((double)errors[row][column], rgb);
            render_fill(image, x + CELL * column, y + PANEL - CELL * (row + 1), CELL, CELL, rgb);
            worst = fmaxf(worst, errors[row][column]);
        }
    draw_axes(image, x, y, kind);
    snprintf(line, sizeof line, "%.*s, %s: worst %.2g", (int)name_length(title), title,
             kind == STABILITY_MAP_HALF ? "f_a" : "f", (double)worst);
    render_text_at(image, x + 4, y - 10, 0.0, line, TEXT, BLACK);
}

static void draw_colour_bar(render_image *image, int x, int y, int height)
{
    static const struct {
        double error;
        const char *label;
    } marks[] = {
        {1e-8, "1e-8"},           {1e-7, "1e-7"}, {1e-6, "1e-6"}, {4e-6, "4e-6: bar of f_a"},
        {2e-5, "2e-5: bar of f"}, {1e-4, "1e-4"}, {1e-3, "1e-3"}, {1e-2, "1e-2"}};
    render_colour_bar(image, x, y, BAR_WIDTH, height);
    for (size_t k = 0; k < sizeof marks / sizeof marks[0]; k++) {
        int at = y + height - (int)lround(height * log(marks[k].error / LOW) / log(HIGH / LOW));
        render_fill(image, x + BAR_WIDTH, at, 5, 1, GREY);
        render_text_at(image, x + BAR_WIDTH + 9, at + TEXT / 2, 0.0, marks[k].label, TEXT, GREY);
    }
    render_text_at(image, x, y - 10, 0.0, "relative error", TEXT, BLACK);
}

/* The backends that are drawn, and what they are called. */
static int choose(stability_backend *backends, int count, stability_backend *chosen[MOST_PANELS])
{
    static const char *const kinds[] = {"c plain", "glsl fast", "glsl half"};
    int found = 0;
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++)
        for (int b = 0; b < count; b++)
            if (strncmp(backends[b].name, kinds[k], strlen(kinds[k])) == 0) {
                chosen[found++] = &backends[b];
                break;
            }
    return found;
}

typedef float panel_errors[STABILITY_MAP_SIDE][STABILITY_MAP_SIDE];

static hnbrdf_result measure(const hnbrdf_model *model, stability_backend **chosen, int count,
                             panel_errors *errors, hnbrdf_error *error)
{
    hnbrdf_result result = HNBRDF_OK;
    int begun = 0;
    for (; begun < count && !result; begun++)
        result = chosen[begun]->begin(chosen[begun], model, error);
    begun -= result != HNBRDF_OK;
    for (int kind = 0; kind < STABILITY_MAPS && !result; kind++)
        result = stability_map(model, hnbrdf_model_material(model, 0), (stability_map_kind)kind,
                               chosen, count, errors + kind * count, error);
    for (int b = 0; b < begun; b++)
        chosen[b]->end(chosen[b]);
    return result;
}

static hnbrdf_result draw(const char *path, const hnbrdf_model *model, const char *model_path,
                          stability_backend **chosen, int count, panel_errors *errors,
                          hnbrdf_error *error)
{
    static const float white[3] = {1.0f, 1.0f, 1.0f};
    char line[256];
    render_image image = {0};
    int width = LEFT + 2 * ACROSS + BAR_WIDTH + 130, height = TOP + count * DOWN;
    hnbrdf_result result = render_image_create(width, height, 0, &image, error);
    if (result)
        return result;
    render_fill(&image, 0, 0, width, height, white);
    snprintf(line, sizeof line,
             "Worst relative error of a cell against the formulas in many digits: %.80s, %.60s",
             model_path, hnbrdf_model_material_name(model, 0));
    render_text(&image, 16, 28, line, 7, BLACK);
    render_text(
        &image, 16, 48,
        "left: the analytic part f_a; right: the whole f, relative to f before its floor is "
        "subtracted",
        TEXT, GREY);
    for (int b = 0; b < count; b++)
        for (int kind = 0; kind < STABILITY_MAPS; kind++)
            draw_panel(&image, LEFT + kind * ACROSS, TOP + b * DOWN, (stability_map_kind)kind,
                       chosen[b]->name, errors[kind * count + b]);
    draw_colour_bar(&image, LEFT + 2 * ACROSS - 44, TOP, PANEL);
    result = render_image_write(&image, path, NULL, error);
    render_image_free(&image);
    return result;
}

hnbrdf_result stability_plot(const char *path, const hnbrdf_model *model, const char *model_path,
                             stability_backend *backends, int backend_count, hnbrdf_error *error)
{
    stability_backend *chosen[MOST_PANELS];
    int count = choose(backends, backend_count, chosen);
    panel_errors *errors = calloc((size_t)(STABILITY_MAPS * MOST_PANELS), sizeof *errors);
    if (!errors)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    hnbrdf_result result = measure(model, chosen, count, errors, error);
    if (!result)
        result = draw(path, model, model_path, chosen, count, errors, error);
    free(errors);
    return result;
}
