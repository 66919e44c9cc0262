/* test_core_variants.c: every variant, every way to call it, and the definition give the same bits.
 *
 * Tolerance: none. All is made of operations that IEEE 754 rounds in one way only. A plain program
 * without cmocka: it is also compiled for other machines and run in an emulator. Prints one line a
 * variant with a checksum of all values, which has to be the same on every machine. */
#include "fitted_support.h"
#include "core/compose.h"
#include "core/encoding.h"
#include "core/frame.h"
#include "core/network.h"
#include "variants_sweep.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Widths around every vector and register tile, the limits, no latent code. */
static const struct {
    int hidden, layers, latent;
} shapes[] = {{1, 1, 0},  {5, 1, 4},  {8, 2, 4},  {13, 2, 7}, {16, 3, 8}, {17, 2, 4}, {27, 1, 16},
              {32, 2, 4}, {33, 2, 4}, {41, 1, 2}, {48, 2, 4}, {57, 1, 4}, {64, 4, 16}};
enum { SHAPES = sizeof shapes / sizeof shapes[0], PAIRS = 53, MATERIALS = 9 };

/* One model's inputs, and the values that the definition gives for them. */
typedef struct scene {
    float wi[PAIRS][3], wo[PAIRS][3], u[PAIRS][2];
    hnbrdf_material materials[PAIRS]; /* [MATERIALS] are used by index, all of them without */
    int index[PAIRS];
} scene;

static const char *what;
static int failures;

static void same(const char *call, const scene *s, int pair, const float *found,
                 const float *expected, int count)
{
    if (memcmp(found, expected, (size_t)count * sizeof *found) == 0)
        return;
    if (failures++ < 10)
        fprintf(stderr,
                "%s, %s: (%.9g %.9g %.9g) for wi %.9g %.9g %.9g, wo %.9g %.9g %.9g, expected "
                "(%.9g %.9g %.9g)\n",
                what, call, (double)found[0], (double)found[count > 1],
                (double)found[count > 1 ? 2 : 0], (double)s->wi[pair][0], (double)s->wi[pair][1],
                (double)s->wi[pair][2], (double)s->wo[pair][0], (double)s->wo[pair][1],
                (double)s->wo[pair][2], (double)expected[0], (double)expected[count > 1],
                (double)expected[count > 1 ? 2 : 0]);
}

/* Channel c of an edited material, likewise. */
static float edited_by_definition(const hnbrdf_model_desc *desc, const hnbrdf_material *m,
                                  const hnbrdf_pair *pair, const hnbrdf_pair *seen, int c,
                                  const float *out, float specular)
{
    const hnbrdf_fitted *fitted = &m->fitted;
    float then = hnbrdf_fitted_specular(pair, seen, fitted->alpha[0], fitted->alpha[1],
                                        hnbrdf_ggx_area(fitted->alpha[0], fitted->alpha[1]));
    float eta = hnbrdf_carried_eta(m->eta[c], fitted->eta[c]);
    float now =
        hnbrdf_microfacet(hnbrdf_carried_kd(m->kd[c], fitted->kd[c]), m->eta[c], pair->c, specular);
    return hnbrdf_compose_edited(out[c], out[c + 3], now,
                                 hnbrdf_microfacet(fitted->kd[c], eta, pair->c, then),
                                 hnbrdf_added_kd(m->kd[c], fitted->kd[c]) * HNBRDF_INV_PI,
                                 desc->scale, desc->shift, desc->floor);
}

/* What its network sees. */
static hnbrdf_pair seen_by_definition(const hnbrdf_model_desc *desc, const hnbrdf_material *m,
                                      const hnbrdf_pair *pair, float specular)
{
    const hnbrdf_fitted *fitted = &m->fitted;
    float shine[3], carried[3];
    for (int c = 0; c < 3; c++) {
        carried[c] = hnbrdf_carried_kd(m->kd[c], fitted->kd[c]) * HNBRDF_INV_PI;
        shine[c] = hnbrdf_fresnel_dielectric(m->eta[c], pair->c) * specular;
    }
    return hnbrdf_seen(desc->encoding, pair, hnbrdf_warp_factor(m->alpha[0], fitted->alpha[0]),
                       hnbrdf_warp_factor(m->alpha[1], fitted->alpha[1]),
                       hnbrdf_specular_part(shine, carried));
}

/* f and f_a term by term, as the headers of src/core define them. */
static void by_definition(const hnbrdf_model *model, const hnbrdf_material *m, const float wi[3],
                          const float wo[3], float f[3], float f_a[3])
{
    const hnbrdf_model_desc *desc = &model->desc;
    for (int c = 0; c < 3; c++)
        f[c] = f_a[c] = 0.0f;
    if (!(wi[2] > 0.0f && wo[2] > 0.0f))
        return;
    float i[3], o[3], x[HNBRDF_ENCODING_SIZE], out[HNBRDF_MAX_OUTPUTS];
    hnbrdf_to_tangent(hnbrdf_frame_of(m), wi, i);
    hnbrdf_to_tangent(hnbrdf_frame_of(m), wo, o);
    hnbrdf_pair pair = hnbrdf_pair_make(i, o);
    const int edited = desc->kind == HNBRDF_KIND_HYBRID && hnbrdf_material_is_edited(m);
    float specular = hnbrdf_specular(&pair, m->alpha[0], m->alpha[1]);
    hnbrdf_pair seen = pair;
    if (edited)
        seen = seen_by_definition(desc, m, &pair, specular);
    for (int c = 0; c < 3; c++)
        f_a[c] = hnbrdf_microfacet(m->kd[c], m->eta[c], pair.c, specular);
    if (desc->kind != HNBRDF_KIND_GGX) {
        hnbrdf_encode(desc->encoding, &seen, x);
        hnbrdf_network(desc, m->latent, x, out);
    }
    for (int c = 0; c < 3; c++)
        switch (desc->kind) {
        case HNBRDF_KIND_HYBRID:
            f[c] = edited ? edited_by_definition(desc, m, &pair, &seen, c, out, specular)
                          : hnbrdf_compose_hybrid(out[c], out[c + 3], f_a[c], desc->scale,
                                                  desc->shift, desc->floor);
            break;
        case HNBRDF_KIND_NEURAL:
            f[c] = hnbrdf_compose_neural(out[c], desc->scale, desc->shift, desc->floor);
            break;
        case HNBRDF_KIND_GGX:
        default:
            f[c] = hnbrdf_finish(f_a[c]);
            break;
        }
    for (int c = 0; c < 3; c++)
        f_a[c] = desc->kind == HNBRDF_KIND_NEURAL ? 0.0f : hnbrdf_finish(f_a[c]);
}

/* FNV-1a over the bits, low byte first on every machine. */
static void add_to(uint64_t *checksum, const float *values, int count)
{
    for (int i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        for (int b = 0; b < 32; b += 8)
            *checksum = (*checksum ^ ((bits >> b) & 0xff)) * 0x100000001b3u;
    }
}

static void check_singles(const hnbrdf_model *model, const scene *s, uint64_t *checksum)
{
    for (int k = 0; k < PAIRS; k++) {
        const hnbrdf_material *m = &s->materials[s->index[k]];
        const float *wi = s->wi[k], *wo = s->wo[k];
        float expected[3], expected_a[3], f[3];
        hnbrdf_prepared prepared;
        hnbrdf_sample_result sample, prepared_sample;
        by_definition(model, m, wi, wo, expected, expected_a);
        hnbrdf_prepare(model, m, &prepared);
        hnbrdf_eval(model, m, wi, wo, f);
        same("eval", s, k, f, expected, 3);
        add_to(checksum, f, 3);
        hnbrdf_prepared_eval(&prepared, wi, wo, f);
        same("prepared_eval", s, k, f, expected, 3);
        hnbrdf_eval_analytic(model, m, wi, wo, f);
        same("eval_analytic", s, k, f, expected_a, 3);
        float pdf = hnbrdf_pdf(model, m, wi, wo),
              prepared_pdf = hnbrdf_prepared_pdf(&prepared, wi, wo);
        same("prepared_pdf", s, k, &prepared_pdf, &pdf, 1);
        add_to(checksum, &pdf, 1);
        hnbrdf_sample(model, m, wo, s->u[k], &sample);
        hnbrdf_prepared_sample(&prepared, wo, s->u[k], &prepared_sample);
        same("prepared_sample", s, k, prepared_sample.weight, sample.weight, 3);
        same("prepared_sample, pdf", s, k, &prepared_sample.pdf, &sample.pdf, 1);
        same("prepared_sample, wi", s, k, prepared_sample.wi, sample.wi, 3);
        add_to(checksum, sample.wi, 3);
        add_to(checksum, &sample.pdf, 1);
        add_to(checksum, sample.weight, 3);
    }
}

/* Every call for `count` pairs, whose values lie `step` floats apart: nothing between them is
 * touched. */
static void check_batches(const hnbrdf_model *model, const scene *s, int count, size_t step)
{
    static const char *const calls[] = {"eval_batch", "eval_analytic_batch", "eval_many",
                                        "eval_many, NULL", "eval_many, one material"};
    const size_t dense = 3 * sizeof(float), stride = step * sizeof(float);
    const float *wi = s->wi[0], *wo = s->wo[0];
    for (int call = 0; call < 5; call++) {
        float f[PAIRS * 5], expected[3], expected_a[3];
        int one[PAIRS];
        for (size_t k = 0; k < sizeof f / sizeof f[0]; k++)
            f[k] = -7.0f;
        for (int k = 0; k < PAIRS; k++)
            one[k] = 3;
        const hnbrdf_material *m = s->materials;
        if (call == 0)
            hnbrdf_eval_batch(model, m, (size_t)count, wi, 0, wo, dense, f, stride);
        else if (call == 1)
            hnbrdf_eval_analytic_batch(model, m, (size_t)count, wi, dense, wo, 0, f, stride);
        else
            hnbrdf_eval_many(model, m,
                             call == 2   ? s->index
                             : call == 3 ? NULL
                                         : one,
                             (size_t)count, wi, 0, wo, 0, f, stride);
        for (int k = 0; k < count; k++) {
            int material = call < 2 ? 0 : call == 2 ? s->index[k] : call == 3 ? k : 3;
            by_definition(model, m + material, s->wi[k], s->wo[k], expected, expected_a);
            same(calls[call], s, k, f + (size_t)k * step, call == 1 ? expected_a : expected, 3);
        }
        for (size_t k = 0; k < sizeof f / sizeof f[0]; k++)
            if ((k % step >= 3 || k >= (size_t)count * step) && f[k] != -7.0f && failures++ < 10)
                fprintf(stderr, "%s, %s: writes outside its values\n", what, calls[call]);
    }
}

static void fill_scene(sweep *s, scene *made)
{
    for (int k = 0; k < PAIRS; k++) {
        sweep_pair(s, made->wi[k], made->wo[k]);
        for (int i = 0; i < 2; i++)
            made->u[k][i] = sweep_unit(s);
        sweep_material(s, k >= MATERIALS, &made->materials[k]);
        if (k % 2) /* every second one is edited, from what the one before is */
            made->materials[k].fitted = as_fitted(made->materials[k - 1]).fitted;
        /* some runs, some disorder */
        made->index[k] = k % 3 ? (int)(sweep_u32(s) % MATERIALS) : k / 8;
    }
}

/* All kinds, encodings and shapes by one variant. */
static uint64_t check_variant(hnbrdf_variant variant)
{
    static const int counts[] = {0, 1, 2, 15, 16, 17, 31, 33, 48, PAIRS};
    uint64_t checksum = 0xcbf29ce484222325u;
    sweep s = {2026};
    scene made;
    for (int kind = HNBRDF_KIND_HYBRID; kind <= HNBRDF_KIND_GGX; kind++)
        for (int encoding = 0; encoding < (kind == HNBRDF_KIND_GGX ? 1 : 5); encoding++)
            for (int shape = 0; shape < (kind == HNBRDF_KIND_GGX ? 1 : SHAPES); shape++) {
                int first = (encoding * SHAPES + shape) % 10;
                hnbrdf_model *plain =
                    sweep_model(&s, (hnbrdf_kind)kind, (hnbrdf_encoding)encoding,
                                shapes[shape].hidden, shapes[shape].layers, shapes[shape].latent);
                hnbrdf_model *model = plain ? sweep_variant(plain, variant) : NULL;
                if (!model) {
                    fprintf(stderr, "%s: no model\n", what);
                    exit(1);
                }
                fill_scene(&s, &made);
                check_singles(model, &made, &checksum);
                for (int n = 0; n < 10; n++)
                    if (n == first || n == 9 || kind == HNBRDF_KIND_GGX)
                        check_batches(model, &made, counts[n], 3 + (size_t)(n + shape) % 3);
                hnbrdf_model_free(model);
                hnbrdf_model_free(plain);
            }
    return checksum;
}

int main(void)
{
    uint64_t reference = 0;
    for (int v = HNBRDF_VARIANT_PLAIN; v <= HNBRDF_VARIANT_NEON; v++) {
        if (!hnbrdf_variant_available((hnbrdf_variant)v))
            continue;
        what = hnbrdf_variant_name((hnbrdf_variant)v);
        uint64_t checksum = check_variant((hnbrdf_variant)v);
        if (v == HNBRDF_VARIANT_PLAIN)
            reference = checksum;
        failures += checksum != reference;
        printf("%s checksum %08lx%08lx\n", what, (unsigned long)(checksum >> 32),
               (unsigned long)(checksum & 0xffffffffu));
    }
    if (failures)
        fprintf(stderr, "test_core_variants: %d differences\n", failures);
    return failures != 0;
}
