/* hold.c: which rank has which material, and what all know of it. */
#include "fit/trainer.h"

#include "base/error.h"
#include "base/hash.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ASYMMETRY_PAIRS = 4096 };
#define RECIPROCAL 0.02 /* data whose asymmetry is less count as reciprocal */

/* ---- Owners ---------------------------------------------------------------------------------- */

/* What a rank says of itself: a hash of what all must have been given alike, then a bit for each
 * material that it has. */
static size_t claim_bytes(const trainer *t)
{
    return sizeof(uint64_t) + ((size_t)t->count + 7) / 8;
}

static uint64_t hash_number(uint64_t h, double value)
{
    return hnbrdf_hash(h, &value, sizeof value);
}

/* Of the options that decide which calls are made and what comes of them. */
static uint64_t hash_options(const trainer *t)
{
    const hnbrdf_fit_options *o = &t->options;
    const double numbers[] = {t->count,
                              o->kind,
                              o->hidden,
                              o->layers,
                              o->latent,
                              (double)o->floor,
                              o->analytic,
                              (double)o->steps,
                              o->seconds,
                              o->batch,
                              o->pool,
                              (double)o->learning_rate,
                              o->loss,
                              o->schedule,
                              (double)o->uniform_share,
                              (double)o->horizon_share,
                              (double)o->bright_share,
                              (double)o->lift,
                              (double)o->seed,
                              o->freeze != NULL,
                              o->materials != NULL,
                              o->checkpoint != NULL,
                              o->resume,
                              t->ranks.size};
    uint64_t h = HNBRDF_HASH_START;
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        h = hash_number(h, numbers[i]);
    return o->encoding ? hnbrdf_hash(h, o->encoding, strlen(o->encoding)) : h;
}

static int has(const unsigned char *claim, int m)
{
    return claim[sizeof(uint64_t) + (size_t)m / 8] >> (m % 8) & 1;
}

/* Of the ranks that have material m, the m-th, counted round and round; -1: none has. */
static int owner_of(const trainer *t, const unsigned char *claims, int m)
{
    const size_t each = claim_bytes(t);
    int holders = 0;
    for (int r = 0; r < t->ranks.size; r++)
        holders += has(claims + (size_t)r * each, m);
    int wanted = holders ? m % holders : -1;
    for (int r = 0; r < t->ranks.size && holders; r++)
        if (has(claims + (size_t)r * each, m) && wanted-- == 0)
            return r;
    return -1;
}

static hnbrdf_result settle_claims(trainer *t, const unsigned char *claims, hnbrdf_error *error)
{
    for (int r = 1; r < t->ranks.size; r++)
        if (memcmp(claims, claims + (size_t)r * claim_bytes(t), sizeof(uint64_t)) != 0)
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                               "rank %d of %d was given other options than rank 0, expected the "
                               "same on all",
                               r, t->ranks.size);
    t->held_count = 0;
    for (int m = 0; m < t->count; m++) {
        t->owner[m] = owner_of(t, claims, m);
        if (t->owner[m] < 0)
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "material %d of %d to fit is NULL%s",
                               m, t->count, t->ranks.size > 1 ? " on every rank" : "");
        t->at[m] = -1;
        if (t->owner[m] == t->ranks.rank) {
            t->at[m] = t->held_count;
            t->held[t->held_count++] = m;
        }
    }
    return HNBRDF_OK;
}

static hnbrdf_result find_owners(trainer *t, hnbrdf_error *error)
{
    const size_t ranks = (size_t)t->ranks.size, each = claim_bytes(t);
    unsigned char *mine = calloc(1, each), *all = calloc(ranks, each);
    size_t *bytes = calloc(ranks, sizeof *bytes);
    hnbrdf_result result = HNBRDF_OK;
    if (!mine || !all || !bytes) {
        result =
            hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory for %d ranks", t->ranks.size);
    } else {
        const uint64_t hash = hash_options(t);
        memcpy(mine, &hash, sizeof hash);
        for (int m = 0; m < t->count; m++)
            if (t->data && t->data[m])
                mine[sizeof hash + (size_t)m / 8] |= (unsigned char)(1 << m % 8);
        for (size_t r = 0; r < ranks; r++)
            bytes[r] = each;
        result = hnbrdf_fit_gather(t, mine, all, bytes) ? settle_claims(t, all, error)
                                                        : hnbrdf_fit_fail_lost(t, error);
    }
    free(mine);
    free(all);
    free(bytes);
    return result;
}

/* ---- What all know --------------------------------------------------------------------------- */

hnbrdf_result hnbrdf_fit_hold(trainer *t, hnbrdf_error *error)
{
    const size_t count = (size_t)t->count;
    t->owner = calloc(count, sizeof(int));
    t->held = calloc(count, sizeof(int));
    t->at = calloc(count, sizeof(int));
    t->known = calloc(count, sizeof *t->known);
    if (!t->owner || !t->held || !t->at || !t->known)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory for %d materials", t->count);
    hnbrdf_result result = find_owners(t, error);
    for (int k = 0; k < t->held_count && !result; k++) {
        const hnbrdf_measured *measured = t->data[t->held[k]];
        fit_material *m = &t->known[t->held[k]];
        snprintf(m->name, sizeof m->name, "%s", hnbrdf_measured_name(measured));
        m->isotropic = hnbrdf_measured_is_isotropic(measured);
    }
    return result ? result : hnbrdf_fit_share_records(t, t->known, sizeof *t->known, error);
}

/* Mean SMAPE between f(wi, wo) and f(wo, wi) of one material over uniform pairs. */
static double asymmetry(const hnbrdf_measured *measured)
{
    hnbrdf_rng rng;
    double sum = 0.0;
    int used = 0;
    hnbrdf_rng_seed(&rng, 0, UINT64_C(3) << 40);
    for (int k = 0; k < ASYMMETRY_PAIRS; k++) {
        float wi[3], wo[3], f[3], g[3];
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, wi, wo);
        if (!hnbrdf_measured_eval(measured, wi, wo, f) ||
            !hnbrdf_measured_eval(measured, wo, wi, g))
            continue;
        for (int c = 0; c < 3; c++)
            if (f[c] != g[c])
                sum += 2.0 * fabs((double)f[c] - (double)g[c]) /
                       (fabs((double)f[c]) + fabs((double)g[c]));
        used += 3;
    }
    return used ? sum / used : 0.0;
}

static void asymmetry_of(void *context, int k, int worker)
{
    trainer *t = context;
    (void)worker;
    t->known[t->held[k]].asymmetry = asymmetry(t->data[t->held[k]]);
}

/* A reciprocal one where the data are, one that sees azimuths where they have one
 * (examples/encodings.md). */
hnbrdf_result hnbrdf_fit_choose_encoding(trainer *t, hnbrdf_error *error)
{
    t->encoding = HNBRDF_ENCODING_ANGLES_AZIMUTHS;
    for (int m = 0; m < t->count; m++)
        if (!t->known[m].isotropic)
            return HNBRDF_OK;
    hnbrdf_threads_run(t->workers, t->held_count, asymmetry_of, t);
    hnbrdf_result result = hnbrdf_fit_share_records(t, t->known, sizeof *t->known, error);
    double sum = 0.0;
    for (int m = 0; m < t->count; m++)
        sum += t->known[m].asymmetry;
    t->encoding =
        sum <= RECIPROCAL * t->count ? HNBRDF_ENCODING_ANGLES : HNBRDF_ENCODING_ANGLES_DIRECTED;
    return result;
}
