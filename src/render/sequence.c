/* sequence.c: random numbers: (0,2)-sequences (Sobol 1967), shifted and shuffled. */
#include "render/render.h"

void render_stream_begin(render_stream *stream, uint64_t seed, uint64_t pixel, uint32_t count)
{
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, seed, pixel);
    stream->mask = 0;
    while (stream->mask < count - 1)
        stream->mask = 2 * stream->mask + 1;
    for (int pair = 0; pair < RENDER_PAIRS; pair++) {
        stream->order[pair] = hnbrdf_rng_u32(&rng);
        stream->shift[pair][0] = hnbrdf_rng_u32(&rng);
        stream->shift[pair][1] = hnbrdf_rng_u32(&rng);
    }
}

static uint32_t reversed(uint32_t x)
{
    x = (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
    x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
    x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
    x = (x & 0x00ff00ffu) << 8 | (x >> 8 & 0x00ff00ffu);
    return x << 16 | x >> 16;
}

/* Flips each bit depending on the seed and the bits above it (Owen 1995, by the hash of Laine and
 * Karras 2011): aligned blocks of 2^k indices go to aligned blocks, in another order. */
static uint32_t shuffled(uint32_t index, uint32_t seed)
{
    uint32_t x = reversed(index) + seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return reversed(x);
}

/* Second dimension of Sobol's sequence: the bits of the index times Pascal's triangle modulo 2,
 * which is the Kronecker product of five matrices {1 1; 0 1}, then reversed. */
static uint32_t sobol(uint32_t index)
{
    index ^= index >> 16;
    index ^= (index & 0xff00ff00u) >> 8;
    index ^= (index & 0xf0f0f0f0u) >> 4;
    index ^= (index & 0xccccccccu) >> 2;
    index ^= (index & 0xaaaaaaaau) >> 1;
    return reversed(index);
}

void render_stream_pair(const render_stream *stream, int pair, uint32_t index, uint32_t u[2])
{
    uint32_t place = shuffled(index, stream->order[pair]) & stream->mask;
    u[0] = reversed(place) ^ stream->shift[pair][0];
    u[1] = sobol(place) ^ stream->shift[pair][1];
}

/* The output function of SplitMix64 (Steele et al. 2014): every bit of x moves half of the
 * result. */
static uint64_t mixed(uint64_t x)
{
    x ^= x >> 30;
    x *= UINT64_C(0xbf58476d1ce4e5b9);
    x ^= x >> 27;
    x *= UINT64_C(0x94d049bb133111eb);
    return x ^ x >> 31;
}

uint64_t render_pixel_key(uint64_t seed, uint64_t pixel)
{
    return mixed(mixed(seed + UINT64_C(0x9e3779b97f4a7c15)) + pixel);
}

void render_endless_pair(uint64_t key, uint32_t dimension, uint32_t index, uint32_t u[2])
{
    uint64_t order = mixed(key + UINT64_C(0x9e3779b97f4a7c15) * (dimension + 1)),
             shift = mixed(~order);
    uint32_t place = shuffled(index, (uint32_t)order);
    u[0] = reversed(place) ^ (uint32_t)shift;
    u[1] = sobol(place) ^ (uint32_t)(shift >> 32);
}
