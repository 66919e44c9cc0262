/* scaling.c: what a fit on many ranks would exchange, on paper. */
#include "bench/scaling.h"

#include <math.h>

/* A network between machines as clusters have it: what one rank gets, and what a message waits. */
#define BYTES_A_SECOND 1e10
#define MESSAGE_SECONDS 2e-6
#define OWN_SECONDS 2.7e-9 /* of Adam, a number of a latent code; measured once, on AVX-512 */
enum { MATERIALS = 10000 };

/* Of one thread, from a short fit. */
typedef struct pace {
    double flops;  /* products a second in both passes */
    double number; /* seconds for the sum and the update of a number of the network */
} pace;

static hnbrdf_result measure_pace(const int net[2], pace *p, hnbrdf_error *error)
{
    hnbrdf_measured *data;
    hnbrdf_model *model;
    hnbrdf_fit_report report;
    const hnbrdf_fit_options options = {.kind = HNBRDF_KIND_NEURAL,
                                        .hidden = net[0],
                                        .layers = net[1],
                                        .latent = 4,
                                        .steps = 100,
                                        .pool = 4096,
                                        .threads = 1};
    hnbrdf_result result = hnbrdf_measured_open_builtin(0, &data, error);
    if (result)
        return result;
    const hnbrdf_measured *const one = data;
    result = hnbrdf_fit(&one, 1, &options, &model, &report, error);
    hnbrdf_fit_traffic t;
    if (!result && !(result = hnbrdf_fit_traffic_of(&options, 1, 1, &t, error))) {
        p->flops = report.flops / report.times.network;
        p->number = report.times.update / (double)report.steps / t.shared;
        hnbrdf_model_free(model);
    }
    hnbrdf_measured_close(data);
    return result;
}

/* Each of the collective calls takes a round of messages for every doubling of the ranks. */
static double network_seconds(const hnbrdf_fit_traffic *t, int ranks)
{
    const double calls = 2.0, rounds = ceil(log2((double)ranks));
    return (t->pair_bytes + t->gradient_bytes + t->sum_bytes) / BYTES_A_SECOND +
           calls * rounds * MESSAGE_SECONDS;
}

static hnbrdf_result print_net(const int net[2], int batch, FILE *file, hnbrdf_error *error)
{
    static const int ranks[] = {1, 10, 100, 1000};
    const hnbrdf_fit_options options = {.hidden = net[0], .layers = net[1], .batch = batch};
    pace p = {1.0, 0.0};
    double alone = 0.0;
    hnbrdf_result result = measure_pace(net, &p, error);
    for (size_t k = 0; k < sizeof ranks / sizeof ranks[0] && !result; k++) {
        hnbrdf_fit_traffic t;
        result = hnbrdf_fit_traffic_of(&options, MATERIALS, ranks[k], &t, error);
        if (result)
            break;
        const double work = t.flops / p.flops, update = t.shared * p.number + t.own * OWN_SECONDS;
        const double talk = ranks[k] > 1 ? network_seconds(&t, ranks[k]) : 0.0;
        const double bytes = t.pair_bytes + t.gradient_bytes + t.sum_bytes;
        alone = k == 0 ? work + update : alone;
        fprintf(file, "%dx%d,%d,%d,%d,%.0f,%.3g,%.0f,%.0f,%.0f,%.3g,%.0f,%.0f,%.0f,%.1f\n", net[0],
                net[1], batch, ranks[k], t.working, t.pairs, t.flops, t.pair_bytes,
                t.gradient_bytes, t.sum_bytes, bytes / t.flops, 1e6 * work, 1e6 * update,
                1e6 * talk, alone / (work + update + talk));
    }
    return result;
}

hnbrdf_result bench_scaling_print(const int (*nets)[2], int count, FILE *file, hnbrdf_error *error)
{
    static const int batches[] = {2048, 65536};
    hnbrdf_result result = HNBRDF_OK;
    fprintf(
        file,
        "# On paper: sizes of messages of a fit of %d materials, the kernels' speed as measured "
        "here on one\n"
        "# thread a rank, and a network of %.0f GB/s and %.0f us a message between ranks. "
        "Nothing was sent. Sums and\n"
        "# Adam (update_us) are done by every rank alike.\n"
        "net,batch,ranks,ranks_at_work,pairs_a_step,flops_a_step,pair_bytes,gradient_bytes,"
        "sum_bytes,bytes_a_flop,arithmetic_us,update_us,network_us,times_faster\n",
        MATERIALS, BYTES_A_SECOND * 1e-9, MESSAGE_SECONDS * 1e6);
    for (int n = 0; n < count && !result; n++)
        for (size_t b = 0; b < sizeof batches / sizeof batches[0] && !result; b++)
            result = print_net(nets[n], batches[b], file, error);
    return result;
}
