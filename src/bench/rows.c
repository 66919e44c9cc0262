/* rows.c: the rows of the table, and what follows from them. */
#include "base/error.h"
#include "bench/bench.h"
#include "bench/peak.h"

#include <string.h>

hnbrdf_result bench_add_row(bench *b, const bench_model *model, const char *backend,
                            const char *variant, const char *weights, const char *precision,
                            bench_row **made, hnbrdf_error *error)
{
    if (b->row_count == BENCH_ROWS)
        return hnbrdf_fail(error, HNBRDF_ERROR_LIMIT, "more than %d rows: fewer models, please",
                           BENCH_ROWS);
    bench_row *row = *made = &b->rows[b->row_count++];
    *row = (bench_row){.model = model,
                       .variant = variant,
                       .weights = weights,
                       .precision = precision,
                       .encoding = model->desc.encoding,
                       .whole = {.ns = (double)NAN},
                       .network = {.ns = (double)NAN},
                       .draw = {.ns = (double)NAN},
                       .density = {.ns = (double)NAN},
                       .compile_ms = (double)NAN,
                       .first_ms = (double)NAN,
                       .smape = model->smape,
                       .psnr = model->psnr};
    snprintf(row->backend, sizeof row->backend, "%s", backend);
    return HNBRDF_OK;
}

const char *bench_net(const bench_model *model, char text[16])
{
    if (model->desc.kind == HNBRDF_KIND_GGX || model->is_baseline)
        snprintf(text, 16, "none");
    else
        snprintf(text, 16, "%dx%d", model->desc.hidden, model->desc.layers);
    return text;
}

double bench_ns(const bench_row *row)
{
    return row->whole.ns - (row->io ? row->io->ns : 0.0);
}

double bench_network_ns(const bench_row *row)
{
    return row->network.ns - (row->io ? row->io->ns : 0.0);
}

const bench_row *bench_ggx(const bench *b, const bench_row *row)
{
    for (int k = 0; k < b->row_count; k++)
        if (b->rows[k].model == &b->models[0] && strcmp(b->rows[k].backend, row->backend) == 0 &&
            (row->model->is_baseline || strcmp(b->rows[k].variant, row->variant) == 0))
            return &b->rows[k];
    return NULL;
}

double bench_peak_fraction(const bench *b, const bench_row *row, double ns, int fused)
{
    const hnbrdf_model_desc *desc = &row->model->desc;
    if (row->model->is_baseline)
        return (double)NAN;
    double operations = 2.0 * (double)hnbrdf_model_multiplications(row->model->model);
    if (!row->io) /* on the CPU the latent code is folded into the first bias */
        operations -= 2.0 * desc->hidden * desc->latent;
    const char *variant = row->io ? bench_peak_name() : row->variant;
    for (int k = 0; k < b->peak_count; k++)
        if (strcmp(b->peaks[k].variant, variant) == 0 && row->threads > 0 && operations > 0.0) {
            double peak = row->threads * (fused ? b->peaks[k].fma : b->peaks[k].muladd);
            return operations / ns * 1e9 / peak;
        }
    return (double)NAN;
}
