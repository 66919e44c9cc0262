/* sampling_measure.c: spheres of one material, drawn in every way and with ever more samples,
 * against a converged one. */
#include "cli/sampling.h"

#include "base/clock.h"
#include "image/difference.h"
#include "render/tabulated.h"

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
static int set_lobes(const sampling_subject *s, sampling_way way, hnbrdf_material *material)
{
    hnbrdf_error error;
    memset(&material->lobes, 0, sizeof material->lobes);
    if (way == SAMPLING_COSINE)
        material->lobes.scale[0] = 1.0f; /* without any share */
    if (way == SAMPLING_PAPER)
        hnbrdf_lobes_paper(&material->lobes);
    if (way == SAMPLING_FITTED &&
        hnbrdf_lobes_fit(s->model, material, &material->lobes, &error) != HNBRDF_OK)
        return cli_fail("%s: %s", s->name, error.text);
    return CLI_OK;
}

/* Seconds of all of this process's threads. */
static double processor_seconds(void)
{
    return hnbrdf_process_seconds();
}

static int render(const sampling_report *r, const render_surface *surface, render_strategy strategy,
                  long spp, long seed, render_image *image)
{
    hnbrdf_error error;
    const render_options options = {.size = (int)r->size,
                                    .spp = (int)spp,
                                    .seed = (uint64_t)seed,
                                    .threads = (int)r->light.threads,
                                    .strategy = strategy};
    return render_sphere(surface, &r->environment, &options, image, &error) == HNBRDF_OK
               ? CLI_OK
               : cli_fail("%s", error.text);
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

/* Renders once and adds to the error; the last picture may stay for the strips. */
static int measure_once(const sampling_report *r, sampling_subject *s, sampling_way way,
                        const render_surface *surface, int k, int repeat, int repeats)
{
    hnbrdf_image_error error;
    render_image image = {0};
    if (render(r, surface, RENDER_BRDF, r->counts[k], r->light.seed + 1 + k + 1000 * repeat,
               &image) != CLI_OK)
        return CLI_FAILURE;
    int code = picture_compare(&image, &s->reference, &error);
    s->runs[way].mse[k] += error.mse / repeats;
    if (repeat + 1 < repeats || !keep_strip(r, s, way, k, &image))
        render_image_free(&image);
    return code;
}

static int measure_way(const sampling_report *r, sampling_subject *s, sampling_way way,
                       const render_surface *surface, picture_progress *progress)
{
    for (int k = 0; k < r->count_count; k++) {
        int repeats = k == 0 ? r->counts[r->at] : 1;
        double before = processor_seconds();
        for (int repeat = 0; repeat < repeats; repeat++)
            if (measure_once(r, s, way, surface, k, repeat, repeats) != CLI_OK)
                return CLI_FAILURE;
        if (k + 1 == r->count_count) /* the longest is known best */
            s->runs[way].ns =
                (processor_seconds() - before) * 1e9 / (s->covered * r->counts[k] * repeats);
        /* Half of the work is the reference. */
        picture_report(progress,
                       0.5 + 0.5 * ((int)way + (k + 1.0) / r->count_count) / SAMPLING_WAYS);
    }
    return CLI_OK;
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

static int measure_all(const sampling_report *r, sampling_subject *s, picture_progress *progress)
{
    hnbrdf_material material = *s->material;
    for (int way = 0; way < SAMPLING_TABULATED; way++) {
        if (set_lobes(s, (sampling_way)way, &material) != CLI_OK)
            return CLI_FAILURE;
        render_surface surface = render_surface_model(s->model, &material);
        if (measure_way(r, s, (sampling_way)way, &surface, progress) != CLI_OK)
            return CLI_FAILURE;
    }
    if (material.alpha[0] != material.alpha[1])
        return CLI_OK;
    hnbrdf_error error;
    render_table *table;
    render_surface surface = render_surface_model(s->model, &material);
    if (render_table_create(&surface, &table, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    render_surface_tabulate(&surface, table);
    int code = measure_way(r, s, SAMPLING_TABULATED, &surface, progress);
    render_table_free(table);
    return code;
}

int sampling_measure(const sampling_report *r, sampling_subject *s, picture_progress *progress)
{
    hnbrdf_material material = *s->material;
    if (set_lobes(s, SAMPLING_FITTED, &material) != CLI_OK)
        return CLI_FAILURE;
    render_surface surface = render_surface_model(s->model, &material);
    if (render(r, &surface, RENDER_MIS, r->light.spp, r->light.seed, &s->reference) != CLI_OK)
        return CLI_FAILURE;
    look_at_reference(s);
    picture_report(progress, 0.5);
    int code = measure_all(r, s, progress);
    s->done = code == CLI_OK;
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
