/* traffic.c: what the ranks of a fit would send each other, without a fit. */
#include "fit/frozen.h"

#include "base/error.h"

/* Of the rank that works on the most tiles. */
static int busiest(const fit_share *s)
{
    int best = 0;
    for (int r = 1; r < s->ranks; r++)
        if (hnbrdf_fit_share_tiles(s, r) > hnbrdf_fit_share_tiles(s, best))
            best = r;
    return best;
}

static hnbrdf_fit_traffic measure(const fit_share *s, const fit_layout *l)
{
    const int me = busiest(s), others = s->ranks - 1;
    const double tiles = hnbrdf_fit_share_tiles(s, me);
    hnbrdf_fit_traffic t = {.pairs = tiles * FIT_TILE};
    t.shared = (double)l->network_count;
    t.own = (double)(hnbrdf_fit_trained(l) - l->network_count);
    t.flops = t.pairs * hnbrdf_fit_pair_flops(l);
    /* materials are dealt to ranks in turn: so many of the tiles are elsewhere */
    t.pair_bytes = tiles * others / s->ranks * (double)hnbrdf_fit_supply_tile_bytes(l);
    for (int r = 0; r < s->ranks; r++) {
        t.working += hnbrdf_fit_share_tiles(s, r) > 0;
        if (r == me)
            continue;
        t.gradient_bytes += (double)hnbrdf_fit_sums_sent(s, l, me, r);
        t.sum_bytes += (double)hnbrdf_fit_sums_gathered(s, l, r);
    }
    return t;
}

/* On a network that stays: a step of the last phase, where every material is on its own. */
static hnbrdf_fit_traffic measure_frozen(const fit_layout *l, int ranks)
{
    const fit_phase *last = &hnbrdf_fit_phases[FIT_PHASES - 1];
    const int count = l->materials, each = (count + ranks - 1) / ranks;
    hnbrdf_fit_traffic t = {.working = ranks < count ? ranks : count};
    t.pairs = (double)each * FIT_PULLS * (last->tiles + FIT_VIEWS_MOST) * FIT_TILE;
    t.flops = t.pairs * hnbrdf_fit_own_flops(l);
    t.own = (double)(hnbrdf_fit_trained(l) - l->network_count);
    t.sum_bytes = 8.0 * (ranks - 1); /* whether to stop */
    return t;
}

hnbrdf_result hnbrdf_fit_traffic_of(const hnbrdf_fit_options *options, int count, int ranks,
                                    hnbrdf_fit_traffic *traffic, hnbrdf_error *error)
{
    hnbrdf_fit_options o = options ? *options : (hnbrdf_fit_options){0};
    const int unit = FIT_TILE * FIT_CHUNKS;
    fit_layout layout;
    if (count < 1 || count > HNBRDF_MAX_MATERIALS || ranks < 1)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "%d materials and %d ranks, expected at least one of each", count,
                           ranks);
    hnbrdf_result result = hnbrdf_fit_fill_options(&o, count, error);
    if (result)
        return result;
    const fit_share share =
        hnbrdf_fit_share_make((o.batch + unit - 1) / unit * FIT_CHUNKS, 0, ranks, 1);
    hnbrdf_fit_layout_make(&layout, o.kind, o.hidden, o.layers, o.latent, count,
                           o.analytic == HNBRDF_FIT_JOINT, o.floor);
    *traffic = o.freeze ? measure_frozen(&layout, ranks) : measure(&share, &layout);
    return HNBRDF_OK;
}
