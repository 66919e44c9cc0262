/* baselines.c: what one would pick instead of a model: the measurement itself, a table of MERL's
 * shape made of it, two GGX lobes, a network for each material. */
#include "bench/baselines.h"
#include "base/bytes.h"
#include "base/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A MERL table: theta_h = (i/90)^2 pi/2, theta_d = (j/90) pi/2, phi_d = k/180 pi. */
enum { THETA_H = 90, THETA_D = 90, PHI_D = 180, BINS = THETA_H * THETA_D * PHI_D, HEADER = 12 };
static const double merl_scale[3] = {1.00 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};
static const double pi = 3.14159265358979323846;

const char *bench_baseline_name(bench_baseline baseline)
{
    static const char *const names[BENCH_BASELINES] = {"measurement", "table-90x90x180",
                                                       "ggx-two-lobes", "nbrdf"};
    return names[baseline];
}

/* ---- The table ------------------------------------------------------------------------------- */

/* Unit vectors of half and difference angles, phi_h = 0. Returns 0 where one is below the
 * horizon. */
static int directions_of(double theta_h, double theta_d, double phi_d, float wi[3], float wo[3])
{
    const double s = sin(theta_h), c = cos(theta_h);
    const double d[3] = {sin(theta_d) * cos(phi_d), sin(theta_d) * sin(phi_d), cos(theta_d)};
    const double i[3] = {c * d[0] + s * d[2], d[1], c * d[2] - s * d[0]};
    const double o[3] = {s * d[2] - c * d[0], -d[1], c * d[2] + s * d[0]};
    for (int k = 0; k < 3; k++) {
        wi[k] = (float)i[k];
        wo[k] = (float)o[k];
    }
    return i[2] > 0.0 && o[2] > 0.0;
}

/* The mean of both orders, as such a table has one value for them; what was measured in one order
 * alone is taken as it is. */
static int value_of(const hnbrdf_measured *measured, const float wi[3], const float wo[3],
                    float f[3])
{
    float g[3];
    int first = hnbrdf_measured_eval(measured, wi, wo, f);
    int second = hnbrdf_measured_eval(measured, wo, wi, g);
    for (int c = 0; c < 3; c++)
        f[c] = first && second ? 0.5f * (f[c] + g[c]) : second ? g[c] : f[c];
    return first || second;
}

static void put_double(unsigned char *to, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int k = 0; k < 8; k++)
        to[k] = (unsigned char)(bits >> 8 * k);
}

/* The file of a table whose samples lie at the middle of their bins. */
static void fill_table(const hnbrdf_measured *measured, unsigned char *bytes)
{
    static const unsigned char sizes[HEADER] = {THETA_H, 0, 0, 0, THETA_D, 0, 0, 0, PHI_D, 0, 0, 0};
    memcpy(bytes, sizes, sizeof sizes);
    for (int bin = 0; bin < BINS; bin++) {
        const double u = (bin / (THETA_D * PHI_D) + 0.5) / THETA_H;
        float wi[3], wo[3], f[3];
        const int valid =
            directions_of(u * u * pi / 2.0, (bin / PHI_D % THETA_D + 0.5) / THETA_D * pi / 2.0,
                          (bin % PHI_D + 0.5) / PHI_D * pi, wi, wo) &&
            value_of(measured, wi, wo, f);
        for (int c = 0; c < 3; c++)
            put_double(bytes + HEADER + 8 * ((size_t)c * BINS + (size_t)bin),
                       valid ? (double)f[c] / merl_scale[c] : -1.0);
    }
}

static hnbrdf_result make_table(const hnbrdf_measured *measured, bench_stand_in *made,
                                hnbrdf_error *error)
{
    const size_t size = HEADER + (size_t)BINS * 24;
    const hnbrdf_measured_options options = {.merl_lookup = HNBRDF_MERL_TRILINEAR};
    unsigned char *bytes = malloc(size);
    if (!bytes)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory for a table of %zu bytes",
                           size);
    fill_table(measured, bytes);
    hnbrdf_result result = hnbrdf_measured_open_memory(bytes, size, hnbrdf_measured_name(measured),
                                                       &options, &made->measured, error);
    made->owned = result == HNBRDF_OK;
    free(bytes);
    return result;
}

/* ---- Two lobes ------------------------------------------------------------------------------- */

typedef struct lobe_pair {
    const hnbrdf_model *ggx;
    bench_two_lobes lobes;
} lobe_pair;

static int eval_lobes(const void *user, const float wi[3], const float wo[3], float f[3])
{
    const lobe_pair *pair = user;
    float scratch[3];
    bench_two_lobes_eval(pair->ggx, &pair->lobes, 1, wi, wo, f, scratch);
    return 1;
}

const hnbrdf_material *bench_ggx_material(const bench *b, const hnbrdf_measured *measured)
{
    const hnbrdf_model *ggx = b->models[0].model;
    return hnbrdf_model_material(ggx, hnbrdf_model_find(ggx, hnbrdf_measured_name(measured)));
}

static hnbrdf_result make_two_lobes(const bench *b, const hnbrdf_measured *measured,
                                    bench_stand_in *made, hnbrdf_error *error)
{
    const hnbrdf_material *one = bench_ggx_material(b, measured);
    if (!one)
        return HNBRDF_OK; /* no such material in any model */
    lobe_pair *pair = malloc(sizeof *pair);
    if (!pair)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    pair->ggx = b->models[0].model;
    const hnbrdf_measured_custom custom = {.name = hnbrdf_measured_name(measured),
                                           .isotropic = hnbrdf_measured_is_isotropic(measured),
                                           .eval = eval_lobes,
                                           .release = free,
                                           .user = pair};
    hnbrdf_result result = bench_two_lobes_fit(pair->ggx, one, measured, &pair->lobes, error);
    made->lobes = pair->lobes;
    if (!result)
        result = hnbrdf_measured_create_custom(&custom, &made->measured, error);
    made->owned = result == HNBRDF_OK;
    if (result)
        free(pair);
    return result;
}

/* ---- Any of them ----------------------------------------------------------------------------- */

hnbrdf_result bench_stand_in_open(const bench *b, bench_baseline baseline,
                                  hnbrdf_measured *measured, bench_stand_in *made,
                                  hnbrdf_error *error)
{
    memset(made, 0, sizeof *made);
    switch (baseline) {
    case BENCH_MEASUREMENT:
        made->measured = measured;
        break;
    case BENCH_TABLE:
        return make_table(measured, made, error);
    case BENCH_TWO_LOBES:
        return make_two_lobes(b, measured, made, error);
    case BENCH_NBRDF:
        for (int k = 0; k < b->nbrdf_count && !made->measured; k++)
            if (strcmp(hnbrdf_measured_name(b->nbrdf[k]), hnbrdf_measured_name(measured)) == 0)
                made->measured = b->nbrdf[k];
        break;
    case BENCH_BASELINES:
        break;
    }
    return HNBRDF_OK;
}

void bench_stand_in_close(bench_stand_in *stand_in)
{
    if (stand_in->owned)
        hnbrdf_measured_close(stand_in->measured);
    memset(stand_in, 0, sizeof *stand_in);
}

/* What one material takes; the sampling tables of the first two are left out. */
static size_t bytes_of(bench_baseline baseline, const hnbrdf_measured *measured)
{
    switch (baseline) {
    case BENCH_TABLE:
        return (size_t)BINS * 3 * sizeof(float);
    case BENCH_TWO_LOBES:
        return 11 * sizeof(float); /* kd, and eta and alpha of two lobes */
    case BENCH_MEASUREMENT:
    case BENCH_NBRDF:
    case BENCH_BASELINES:
        break;
    }
    return hnbrdf_measured_bytes(measured);
}

static int is_wanted(const bench *b, bench_baseline baseline)
{
    return baseline != BENCH_NBRDF || b->nbrdf_count > 0;
}

void bench_add_baselines(bench *b, hnbrdf_measured *const *data, int count,
                         hnbrdf_measured *const *nbrdf, int nbrdf_count)
{
    b->data = data;
    b->data_count = count;
    b->nbrdf = nbrdf;
    b->nbrdf_count = nbrdf_count;
    for (bench_baseline k = BENCH_MEASUREMENT; k < BENCH_BASELINES; k++) {
        bench_model *m = &b->baselines[k];
        if (!is_wanted(b, k))
            continue;
        snprintf(m->name, sizeof m->name, "%s", bench_baseline_name(k));
        m->is_baseline = 1;
        m->desc.kind = k == BENCH_TWO_LOBES ? HNBRDF_KIND_GGX : HNBRDF_KIND_NEURAL;
        m->smape = m->psnr = m->half_smape = m->peer_smape = m->peer_psnr = (double)NAN;
    }
}

double bench_scene_bytes(const bench *b, const bench_model *model)
{
    if (b->data_count == 0)
        return (double)NAN;
    const int per_material = 9 + model->desc.latent; /* kd, eta, two alphas, rotation */
    if (!model->is_baseline) {
        const int analytic = model->desc.kind != HNBRDF_KIND_NEURAL;
        return sizeof(float) * ((double)hnbrdf_model_weight_count(model->model) +
                                b->data_count * (per_material - (analytic ? 0.0 : 9.0)));
    }
    double sum = 0.0;
    for (int m = 0; m < b->data_count; m++) {
        bench_stand_in s = {.measured = b->data[m]};
        const bench_baseline baseline = (bench_baseline)(model - b->baselines);
        if (baseline == BENCH_NBRDF)
            (void)bench_stand_in_open(b, baseline, b->data[m], &s, NULL);
        sum += s.measured ? (double)bytes_of(baseline, s.measured) : 0.0;
    }
    return sum > 0.0 ? sum : (double)NAN;
}
