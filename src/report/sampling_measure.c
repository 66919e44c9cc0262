/* sampling_measure.c: spheres of one material, drawn in every way and with ever more samples,
 * against a converged one. */
#include "report/sampling.h"

#include "base/clock.h"
#include "base/error.h"
#include "image/difference.h"
#include "render/tabulated.h"

#include <math.h>
#include <string.h>

const char *sampling_name(sampling_way way)
{
    static const char *const names[SAMPLING_WAYS] = {"cosine", "paper", "guess", "fitted",
                                                     "tabulated"};
    return names[way];
}

const char *sampling_title(sampling_way way)
{
    static const char *const titles[SAMPLING_WAYS] = {
        "cosine alone", "paper's scheme", "guessed share", "fitted lobes", "tabulated, 5.6 MB"};
    return titles[way];
}

/* All ways but the table are lobes. */
static hnbrdf_result set_lobes(const sampling_report *r, const sampling_subject *s,
                               sampling_way way, hnbrdf_material *material)
{
    hnbrdf_error error;
    memset(&material->lobes, 0, sizeof material->lobes);
    if (way == SAMPLING_COSINE)
        material->lobes.scale[0] = 1.0f; /* without any share */
    if (way == SAMPLING_PAPER)
        hnbrdf_lobes_paper(&material->lobes);
    hnbrdf_result result = HNBRDF_OK;
    if (way == SAMPLING_FITTED)
        result = hnbrdf_lobes_fit(s->model, material, &material->lobes, &error);
    return result == HNBRDF_OK ? result
                               : hnbrdf_fail(r->error, result, "%s: %s", s->name, error.text);
}

/* Seconds of all of this process's threads. */
static double processor_seconds(void)
{
    return hnbrdf_process_seconds();
}

static hnbrdf_result render(const sampling_report *r, const render_surface *surface,
                            render_strategy strategy, long spp, long seed, render_image *image)
{
    const render_options options = {.size = (int)r->size,
                                    .spp = (int)spp,
                                    .seed = (uint64_t)seed,
                                    .threads = (int)r->light.threads,
                                    .strategy = strategy};
    return render_sphere(surface, &r->environment, &options, image, r->error);
}

static int keep_strip(const sampling_report *r, sampling_subject *s, sampling_way way, int k,
                      render_image *image)
{
    for (int n = 0; n < SAMPLING_STRIP_COUNTS && s->has_strip; n++)
        if (r->strips[n] == k) {
            s->strips[n][way] = *image;
            *image = (render_image){0};
            return 1;
        }
    return 0;
}

static void show(const sampling_report *r, const sampling_subject *s, double share)
{
    report_show(&r->watch, ((double)(s - r->subjects) + share) / r->count, s->name);
}

/* Renders once and adds to the error; the last picture may stay for the strips. */
static hnbrdf_result measure_once(const sampling_report *r, sampling_subject *s, sampling_way way,
                                  const render_surface *surface, int k, int repeat, int repeats)
{
    hnbrdf_image_error error = {0};
    render_image image = {0};
    hnbrdf_result code = render(r, surface, RENDER_BRDF, r->counts[k],
                                r->light.seed + 1 + k + 1000 * repeat, &image);
    if (code == HNBRDF_OK)
        code = report_picture_compare(&image, &s->reference, &error, r->error);
    s->runs[way].mse[k] += error.mse / repeats;
    if (repeat + 1 < repeats || !keep_strip(r, s, way, k, &image))
        render_image_free(&image);
    return code;
}

static hnbrdf_result measure_way(const sampling_report *r, sampling_subject *s, sampling_way way,
                                 const render_surface *surface)
{
    hnbrdf_result result = HNBRDF_OK;
    for (int k = 0; k < r->count_count; k++) {
        int repeats = k == 0 ? r->counts[r->at] : 1;
        double before = processor_seconds();
        for (int repeat = 0; repeat < repeats && result == HNBRDF_OK; repeat++)
            result = measure_once(r, s, way, surface, k, repeat, repeats);
        if (result != HNBRDF_OK)
            return result;
        if (k + 1 == r->count_count) /* the longest is known best */
            s->runs[way].ns =
                (processor_seconds() - before) * 1e9 / (s->covered * r->counts[k] * repeats);
        /* Half of the work is the reference. */
        show(r, s, 0.5 + 0.5 * ((int)way + (k + 1.0) / r->count_count) / SAMPLING_WAYS);
    }
    return HNBRDF_OK;
}

/* Its mean and the pixels that the sphere covers. */
static void look_at_reference(sampling_subject *s)
{
    const render_image *image = &s->reference;
    double sum = 0.0, count = 0.0;
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++) {
        s->covered += (double)image->alpha[i];
        if (render_covered(image, image, i)) {
            sum += ((double)image->rgb[3 * i] + (double)image->rgb[3 * i + 1] +
                    (double)image->rgb[3 * i + 2]) /
                   3.0;
            count++;
        }
    }
    s->level = count > 0.0 ? sum / count : 0.0;
}

static hnbrdf_result measure_table(const sampling_report *r, sampling_subject *s,
                                   const hnbrdf_material *material)
{
    render_table *table;
    render_surface surface = render_surface_model(s->model, material);
    hnbrdf_result result = render_table_create(&surface, &table, r->error);
    if (result != HNBRDF_OK)
        return result;
    render_surface_tabulate(&surface, table);
    result = measure_way(r, s, SAMPLING_TABULATED, &surface);
    render_table_free(table);
    return result;
}

static hnbrdf_result measure_all(const sampling_report *r, sampling_subject *s)
{
    hnbrdf_result result = HNBRDF_OK;
    hnbrdf_material material = *s->material;
    for (int way = 0; way < SAMPLING_TABULATED && result == HNBRDF_OK; way++) {
        result = set_lobes(r, s, (sampling_way)way, &material);
        render_surface surface = render_surface_model(s->model, &material);
        if (result == HNBRDF_OK)
            result = measure_way(r, s, (sampling_way)way, &surface);
    }
    if (result != HNBRDF_OK || material.alpha[0] != material.alpha[1])
        return result;
    return measure_table(r, s, &material);
}

hnbrdf_result sampling_measure(const sampling_report *r, int m)
{
    sampling_subject *s = &r->subjects[m];
    hnbrdf_material material = *s->material;
    hnbrdf_result code = set_lobes(r, s, SAMPLING_FITTED, &material);
    if (code != HNBRDF_OK)
        return code;
    render_surface surface = render_surface_model(s->model, &material);
    code = render(r, &surface, RENDER_MIS, r->light.spp, r->light.seed, &s->reference);
    if (code != HNBRDF_OK)
        return code;
    look_at_reference(s);
    show(r, s, 0.5);
    code = measure_all(r, s);
    s->done = code == HNBRDF_OK;
    if (!s->has_strip)
        render_image_free(&s->reference);
    return code;
}

double sampling_ratio(const sampling_subject *s, int k, sampling_way way, sampling_way to)
{
    double mine = s->runs[way].mse[k], other = s->runs[to].mse[k];
    return mine > 0.0 && other > 0.0 ? mine / other : 0.0;
}

double sampling_mean_ratio(const sampling_report *r, int k, sampling_way way, sampling_way to,
                           double alpha)
{
    double sum = 0.0;
    int count = 0;
    for (int m = 0; m < r->count; m++) {
        const sampling_subject *s = &r->subjects[m];
        double ratio =
            s->done && (double)s->material->alpha[0] < alpha ? sampling_ratio(s, k, way, to) : 0.0;
        sum += ratio;
        count += ratio > 0.0;
    }
    return count ? sum / count : (double)NAN;
}

double sampling_mean_efficiency(const sampling_report *r, sampling_way way)
{
    double sum = 0.0;
    int count = 0;
    for (int m = 0; m < r->count; m++) {
        const sampling_subject *s = &r->subjects[m];
        double ratio = s->done ? sampling_ratio(s, 0, way, SAMPLING_TABULATED) : 0.0;
        if (ratio > 0.0) {
            sum += s->runs[SAMPLING_TABULATED].ns / (ratio * s->runs[way].ns);
            count++;
        }
    }
    return count ? sum / count : (double)NAN;
}
