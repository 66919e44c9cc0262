/* run.c: evaluates the cases with every backend and judges each number by the oracle's. */
#include "check/stability.h"

#include "base/error.h"
#include "check/oracle.h"
#include "check/rounding.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *stability_stage_name(stability_stage stage)
{
    static const char *const names[STABILITY_STAGES] = {"analytic", "value", "pdf", "sample"};
    return names[stage];
}

int stability_stage_numbers(stability_stage stage)
{
    static const int numbers[STABILITY_STAGES] = {3, 3, 1, 8};
    return numbers[stage];
}

/* ---- The truth ------------------------------------------------------------------------------- */

/* What number `n` of a stage should be, and what its error is measured by. */
static double truth(const oracle_point *point, stability_stage stage, int n, double *scale)
{
    double expected = stage == STABILITY_ANALYTIC ? point->analytic[n]
                      : stage == STABILITY_VALUE  ? point->value[n]
                                                  : point->pdf;
    *scale = fmax(stage == STABILITY_VALUE ? point->scale[n] : expected, (double)FLT_MIN);
    return expected;
}

/* Sum over all inputs of the relative change of the true value when one of them moves to the next
 * float. */
static double sensitivity(const hnbrdf_model_desc *desc, stability_stage stage,
                          const stability_place *place)
{
    double total = 0.0;
    for (int i = 0; i < 6 + 1 + desc->latent; i++) {
        stability_place moved = *place;
        float *input = i < 6    ? &moved.pair[i]
                       : i == 6 ? &moved.material.rotation
                                : &moved.material.latent[i - 7];
        double ignored;
        oracle_point point;
        if (i == 6 && *input == 0.0f)
            continue;
        *input = nextafterf(*input, 2.0f * *input + 1.0f);
        oracle_evaluate(desc, &moved.material, moved.pair, moved.pair + 3, &point);
        total +=
            fabs(truth(&point, stage, place->channel, &ignored) - place->expected) / place->scale;
    }
    return total;
}

/* ---- Judging --------------------------------------------------------------------------------- */

/* Turning a direction rounds its x and y to 4.5 u, u = 2^-24: two products and a sum of numbers
 * up to 1, and the cosine and sine. Slopes of h = wi + wo are then 9 u/s.z off, in alphas 9
 * u/(s.z alpha), and D = .../(1 + slope^2)^2 changes by at most twice that. Beyond a tenth it is
 * no bound: none is set. */
static double turned_bar(const hnbrdf_material *material, const float pair[6])
{
    double alpha = (double)fminf(material->alpha[0], material->alpha[1]);
    double bar = 18.0 * 0x1p-24 / (alpha * ((double)pair[2] + (double)pair[5]));
    return bar < 0.1 ? bar : (double)INFINITY;
}

/* What rounding the view does to the shares of the lobes: 3 sqrt(wo.z), up to 3, is (2 x + 1) u off
 * between its knots, and shares go with it. A share that is small there and large at the next knot
 * feels that most; the lobe may be all there is of the density. The cosine lobe gets 1 less the
 * others, whose roundings, 6 u, stay, however little is left to it: so much of wi.z / pi, in
 * terms of the density. */
static double shares_bar(const hnbrdf_material *material, const float pair[6], double pdf)
{
    double x = fmin(3.0 * sqrt((double)pair[5]), 3.0), worst = 0.0, rest = 0.0;
    int j = x < 1.0 ? 0 : x < 2.0 ? 1 : 2;
    if (material->lobes.scale[0] == 0.0f || !(pdf > 0.0))
        return 0.0;
    for (int k = 0; k < HNBRDF_LOBES; k++) {
        double from = (double)material->lobes.share[k][j],
               to = (double)material->lobes.share[k][j + 1];
        double share = from + (x - j) * (to - from), off = (2.0 * x + 1.0) * fabs(to - from);
        rest += off;
        if (share > 0.0)
            worst = fmax(worst, off / share);
    }
    return 0x1p-24 * (worst + (rest + 6.0) * fabs((double)pair[2]) / (3.14159265358979 * pdf));
}

/* pdf: the true density there. */
static double bar_of(const stability_case *what, const stability_backend *backend,
                     stability_stage stage, const hnbrdf_material *material, const float pair[6],
                     double pdf)
{
    stability_demand demand = stage == STABILITY_VALUE ? what->value_demand : what->demand;
    double bar = stage == STABILITY_VALUE ? STABILITY_VALUE_BAR : STABILITY_ANALYTIC_BAR;
    if (demand == STABILITY_FINITE)
        return (double)INFINITY;
    if (material->rotation != 0.0f) /* of the case turned, or as the model has it */
        bar += turned_bar(material, pair);
    if (stage == STABILITY_PDF || stage == STABILITY_SAMPLE)
        bar += shares_bar(material, pair, pdf);
    return bar * (stage == STABILITY_VALUE ? backend->loosen_value : backend->loosen);
}

static double spacing(double size)
{
    float rounded = (float)size;
    return (double)(nextafterf(rounded, INFINITY) - rounded);
}

static void note_place(stability_row *row, const stability_block *block, int k, int channel,
                       double got, double expected, double scale)
{
    row->place.material = block->material;
    memcpy(row->place.pair, block->pairs[k], sizeof row->place.pair);
    row->place.channel = channel;
    row->place.got = got;
    row->place.expected = expected;
    row->place.scale = scale;
}

/* Finite and not negative; counts and keeps the first that is not. */
static int is_valid(stability_row *row, const stability_block *block, int k, int n, float value)
{
    int direction = row->stage == STABILITY_SAMPLE && n < 2; /* x and y of a direction have signs */
    int valid = isfinite(value) && (direction || value >= 0.0f);
    row->values++;
    if (valid)
        return 1;
    if (row->not_finite + row->negative == 0)
        note_place(row, block, k, n, (double)value, (double)NAN, (double)NAN);
    if (isfinite(value))
        row->negative++;
    else
        row->not_finite++;
    return 0;
}

/* Of a value beyond its bar: six standard deviations of what rounding in the network's sums must be
 * expected to cost there. Such a place is reported, but is no failure of the code. */
static int is_ill_conditioned(const hnbrdf_model_desc *desc, const stability_row *row,
                              const stability_block *block, const oracle_point *point, int channel,
                              double relative_error)
{
    if (row->stage != STABILITY_VALUE)
        return 0;
    stability_rounding rounding =
        stability_rounding_of(desc, &block->material, point, channel, row->state);
    return relative_error <= rounding.mean + 6.0 * rounding.deviation;
}

static void judge(stability_row *row, const hnbrdf_model_desc *desc, const stability_block *block,
                  int k, int channel, double bar, float value, const oracle_point *point)
{
    double scale, expected = truth(point, row->stage, channel, &scale);
    double error = fabs((double)value - expected), own = fmax(fabs(expected), (double)FLT_MIN);
    if (error <= (double)FLT_MIN) /* subnormal results may be flushed */
        error = 0.0;
    int broken = row->not_finite + row->negative > 0;
    if (!broken && error / scale >= row->worst_scale)
        note_place(row, block, k, channel, (double)value, expected, scale);
    row->worst_scale = fmax(row->worst_scale, error / scale);
    row->worst_own = fmax(row->worst_own, error / own);
    row->worst_ulp = fmax(row->worst_ulp, error / spacing(own));
    row->bar = fmin(row->bar, bar);
    if (error / scale > bar && is_ill_conditioned(desc, row, block, point, channel, error / scale))
        row->ill_conditioned++;
    else
        row->worst_share = fmax(row->worst_share, error / scale / bar);
}

/* A sample's own rules; its density is judged where it says it was drawn. */
static void judge_sample(stability_row *row, const hnbrdf_model_desc *desc,
                         const stability_block *block, int k, const stability_backend *backend,
                         const float values[STABILITY_NUMBERS])
{
    float wi_z = values[2], pdf = values[6];
    row->inconsistent +=
        pdf > 0.0f && (!(wi_z > 0.0f) || memcmp(&pdf, &values[7], sizeof pdf) != 0);
    if (!(pdf > 0.0f) || row->what->not_a_number)
        return;
    stability_block drawn = *block;
    memcpy(drawn.pairs[k], values, 3 * sizeof(float));
    oracle_point point = {
        .pdf = oracle_pdf(desc->kind, &block->material, drawn.pairs[k], drawn.pairs[k] + 3)};
    judge(row, desc, &drawn, k, 0,
          bar_of(row->what, backend, row->stage, &block->material, drawn.pairs[k], point.pdf), pdf,
          &point);
}

/* What must have the bits of `like`, and has, has its errors too: see close_row(). */
static void judge_block(stability_row *row, const hnbrdf_model_desc *desc,
                        const stability_backend *backend, const stability_block *block,
                        float values[STABILITY_BLOCK][STABILITY_NUMBERS],
                        float like[STABILITY_BLOCK][STABILITY_NUMBERS], const oracle_point *points)
{
    int numbers = stability_stage_numbers(row->stage);
    for (int k = 0; k < STABILITY_BLOCK; k++) {
        double bar = bar_of(row->what, backend, row->stage, &block->material, block->pairs[k],
                            points[k].pdf);
        size_t differs = 0;
        int valid = 1;
        for (int n = 0; n < numbers; n++) {
            differs += memcmp(&values[k][n], &like[k][n], sizeof(float)) != 0;
            valid &= is_valid(row, block, k, n, values[k][n]);
        }
        row->differs += differs;
        if (!valid || (row->exact && differs == 0))
            continue;
        if (row->stage == STABILITY_SAMPLE)
            judge_sample(row, desc, block, k, backend, values[k]);
        else
            for (int n = 0; n < numbers && !row->what->not_a_number; n++)
                judge(row, desc, block, k, n, bar, values[k][n], &points[k]);
    }
}

/* ---- Running --------------------------------------------------------------------------------- */

/* What the case multiplies weights and biases by; 0: nothing. */
static float factor_of(const stability_case *what, const hnbrdf_model *model)
{
    hnbrdf_model_desc desc;
    float largest = 0.0f;
    hnbrdf_model_describe(model, &desc);
    if (what->largest_weight == 0.0f || desc.kind == HNBRDF_KIND_GGX)
        return what->weight_factor;
    int columns = 6 + desc.latent;
    for (int k = 0; k <= desc.layers; k++) {
        int rows = k < desc.layers ? desc.hidden : desc.kind == HNBRDF_KIND_HYBRID ? 6 : 3;
        for (int i = 0; i < rows * columns; i++)
            largest = fmaxf(largest, fabsf(desc.weights[k][i]));
        columns = rows;
    }
    return largest > 0.0f ? what->largest_weight / largest : 0.0f;
}

/* A model whose weights and biases are `factor` times those of another one; free with
 * hnbrdf_model_free(). */
static hnbrdf_result scaled_model(const hnbrdf_model *model, float factor, hnbrdf_model **scaled,
                                  hnbrdf_error *error)
{
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    float *copy = malloc((hnbrdf_model_weight_count(model) + 1) * sizeof *copy), *next = copy;
    if (!copy)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "stability: no memory for a network");
    int columns = 6 + desc.latent;
    for (int k = 0; desc.kind != HNBRDF_KIND_GGX && k <= desc.layers; k++) {
        int rows = k < desc.layers ? desc.hidden : desc.kind == HNBRDF_KIND_HYBRID ? 6 : 3;
        const float *weights = next;
        for (int i = 0; i < rows * columns; i++)
            *next++ = desc.weights[k][i] * factor;
        desc.weights[k] = weights;
        const float *biases = next;
        for (int i = 0; i < rows; i++)
            *next++ = desc.biases[k][i] * factor;
        desc.biases[k] = biases;
        columns = rows;
    }
    hnbrdf_result result = hnbrdf_model_create(&desc, NULL, scaled, error);
    free(copy);
    return result;
}

typedef struct runner {
    const stability_options *options;
    stability_backend *backends;
    int backend_count;
    stability_row *rows;
    hnbrdf_error *error;
} runner;

/* The first backend in the state of this one. */
static int first_in_state(const runner *r, int backend)
{
    int first = 0;
    while (r->backends[first].state != r->backends[backend].state)
        first++;
    return first;
}

static hnbrdf_result run_block(const runner *r, const hnbrdf_model_desc *desc,
                               const stability_block *block, const oracle_point *points,
                               stability_row *rows)
{
    for (int stage = 0; stage < STABILITY_STAGES; stage++) {
        float values[STABILITY_BLOCK][STABILITY_NUMBERS],
            firsts[STABILITY_STATES][STABILITY_BLOCK][STABILITY_NUMBERS] = {{{0.0f}}};
        for (int b = 0; b < r->backend_count; b++) {
            stability_backend *backend = &r->backends[b];
            stability_row *row = &rows[b * STABILITY_STAGES + stage];
            if (!(backend->stages & 1 << stage))
                continue;
            hnbrdf_result result =
                backend->run(backend, (stability_stage)stage, block, values, r->error);
            if (result)
                return result;
            if (first_in_state(r, b) == b)
                memcpy(firsts[backend->state], values, sizeof values);
            row->applies = 1;
            judge_block(row, desc, backend, block, values,
                        firsts[row->exact ? backend->state : r->backends[0].state], points);
        }
    }
    return HNBRDF_OK;
}

static void open_rows(const runner *r, const stability_case *what, stability_row *rows)
{
    for (int b = 0; b < r->backend_count; b++)
        for (int stage = 0; stage < STABILITY_STAGES; stage++) {
            stability_row *row = &rows[b * STABILITY_STAGES + stage];
            memset(row, 0, sizeof *row);
            row->what = what;
            memcpy(row->backend, r->backends[b].name, sizeof row->backend);
            row->stage = (stability_stage)stage;
            row->state = r->backends[b].state;
            row->exact = r->backends[b].exact && first_in_state(r, b) != b;
            row->bar = (double)INFINITY;
        }
}

/* first: the row of the first backend in this state for the same case and stage. */
static void close_row(const hnbrdf_model_desc *desc, const stability_row *first, stability_row *row)
{
    if (row->exact && row->differs == 0) {
        row->inconsistent = first->inconsistent;
        row->ill_conditioned = first->ill_conditioned;
        row->worst_own = first->worst_own;
        row->worst_scale = first->worst_scale;
        row->worst_ulp = first->worst_ulp;
        row->worst_share = first->worst_share;
        row->bar = first->bar;
        row->place = first->place;
    } else if (row->applies && row->worst_scale > 0.0 && isfinite(row->place.expected)) {
        row->place.sensitivity = sensitivity(desc, row->stage, &row->place);
    }
    row->within = row->not_finite + row->negative + row->inconsistent == 0 &&
                  row->worst_share <= 1.0 && !(row->exact && row->differs > 0);
}

static hnbrdf_result run_case(const runner *r, const stability_case *what,
                              const hnbrdf_model *model, stability_row *rows)
{
    /* Cases that break one field after the other need as many blocks. */
    int least = what->not_a_number ? STABILITY_FIELDS + 1 : 1;
    int blocks = r->options->blocks < least ? least : r->options->blocks;
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    open_rows(r, what, rows);
    for (int k = 0; k < blocks; k++) {
        stability_block block;
        oracle_point points[STABILITY_BLOCK];
        stability_block_make(what, k, &desc.materials[k % desc.material_count], &block);
        for (int i = 0; i < STABILITY_BLOCK && !what->not_a_number; i++)
            oracle_evaluate(&desc, &block.material, block.pairs[i], block.pairs[i] + 3, &points[i]);
        hnbrdf_result result = run_block(r, &desc, &block, points, rows);
        if (result)
            return result;
    }
    for (int b = 0; b < r->backend_count; b++)
        for (int stage = 0; stage < STABILITY_STAGES; stage++)
            close_row(&desc, &rows[first_in_state(r, b) * STABILITY_STAGES + stage],
                      &rows[b * STABILITY_STAGES + stage]);
    return HNBRDF_OK;
}

static void end_backends(const runner *r)
{
    for (int b = 0; b < r->backend_count; b++)
        r->backends[b].end(&r->backends[b]);
}

/* On failure those before the one that failed are ended again. */
static hnbrdf_result begin_backends(const runner *r, const hnbrdf_model *model)
{
    for (int b = 0; b < r->backend_count; b++) {
        hnbrdf_result result = r->backends[b].begin(&r->backends[b], model, r->error);
        if (result) {
            const runner begun = {.backends = r->backends, .backend_count = b};
            end_backends(&begun);
            return result;
        }
    }
    return HNBRDF_OK;
}

/* The cases from `first` on that ask for one factor on the weights; *next receives the first of the
 * others. */
static hnbrdf_result run_cases(const runner *r, const hnbrdf_model *model, int first, int *next)
{
    float factor = factor_of(&stability_cases[first], model);
    hnbrdf_model *scaled = NULL;
    hnbrdf_result result = HNBRDF_OK;
    if (factor != 0.0f)
        result = scaled_model(model, factor, &scaled, r->error);
    if (!result)
        result = begin_backends(r, scaled ? scaled : model);
    if (result) {
        hnbrdf_model_free(scaled);
        return result;
    }
    int k = first;
    for (; !result && k < stability_case_count && factor_of(&stability_cases[k], model) == factor;
         k++) {
        result = run_case(r, &stability_cases[k], scaled ? scaled : model,
                          r->rows + k * r->backend_count * STABILITY_STAGES);
        if (r->options->progress)
            r->options->progress(r->options->progress_user, (k + 1.0) / stability_case_count);
    }
    end_backends(r);
    hnbrdf_model_free(scaled);
    *next = k;
    return result;
}

hnbrdf_result stability_run(const hnbrdf_model *model, const stability_options *options,
                            stability_backend *backends, int backend_count, stability_row *rows,
                            hnbrdf_error *error)
{
    const runner r = {options, backends, backend_count, rows, error};
    hnbrdf_result result = HNBRDF_OK;
    for (int k = 0; k < stability_case_count && !result;)
        result = run_cases(&r, model, k, &k);
    return result;
}
