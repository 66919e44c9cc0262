#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// sphere.comp: the sphere of `hnbrdf render` on a device: one invocation a pixel, the random numbers, directions and
// sums of src/render (sphere.c, shade.c, environment.c, turn.h), function by function. All of it is `precise` + - * /
// sqrt and whole numbers: on a device that rounds those correctly, with HNBRDF_EXACT 1, every bit is that of the CPU.
#include "hybrid_brdf.glsl"
#include "scene.glsl"

const int STRATEGY_MIS = 0, STRATEGY_LIGHT = 1, STRATEGY_BRDF = 2, STRATEGIES = 3; // render_strategy
const uint BLOCK = 64u; // RENDER_BLOCK: hits are numbered within this many samples, dispatches begin at multiples of it
const int PAIR_LENS = 0, PAIR_LIGHT = 1, PAIR_DIRECTION = 2, PAIRS = 4; // the fourth is that of guides

layout(constant_id = 0) const int MODE = 0; // a strategy; + STRATEGIES: writes down what it draws instead of sums
const int STRATEGY = MODE % STRATEGIES;
const bool RECORDS = MODE >= STRATEGIES;

layout(local_size_x = 64) in;
// Radiance and density in 1/sr of each texel.
layout(std430, set = 0, binding = 0) readonly buffer Texels { vec4 texels[]; };
// Where places end, where the search for one begins: rows, then the texels of each row.
layout(std430, set = 0, binding = 1) readonly buffer Places { uvec2 places[]; };
// Eight numbers a pixel, the sum of radiance in two parts, the number of hits; or, of a recording, ten for each of the
// two directions of a sample: wi, wo, f, 1 if it counts.
layout(std430, set = 0, binding = 2) buffer Results { float results[]; };
// Heights of the caps above the borders of rows.
layout(std430, set = 0, binding = 3) readonly buffer Caps { float caps[]; };
layout(push_constant) uniform Push {
    uint pixels, first_pixel;             // of this dispatch
    uint first_sample, samples, spp;      // of this dispatch; of the picture
    int size, width, height;              // of the picture; of the map
    uint seed_low, seed_high;
    float turn;                           // of the map
    float frame2, camera_distance, scale;       // of the camera
};

// ---- Random numbers: PCG32, shuffled (0,2)-sequences (shade.c) -----------------------------------------------------

struct generator {
    uvec2 state, stream; // low and high half
};

uint next_number(inout generator g)
{
    const uvec2 m = uvec2(0x4C957F2Du, 0x5851F42Du);
    uvec2 old = g.state;
    uint low, high, carry;
    umulExtended(old.x, m.x, high, low);
    low = uaddCarry(low, g.stream.x, carry);
    g.state = uvec2(low, high + old.x * m.y + old.y * m.x + g.stream.y + carry);
    uvec2 x = uvec2(old.x >> 18 | old.y << 14, old.y >> 18) ^ old;
    uint shifted = x.x >> 27 | x.y << 5, turns = old.y >> 27;
    return shifted >> turns | shifted << (-turns & 31u);
}

generator make_generator(uint pixel)
{
    generator g = generator(uvec2(0u), uvec2(pixel << 1 | 1u, pixel >> 31));
    next_number(g);
    uint carry;
    g.state.x = uaddCarry(g.state.x, seed_low, carry);
    g.state.y += seed_high + carry;
    next_number(g);
    return g;
}

struct stream {
    uint mask, order[PAIRS];
    uvec2 shift[PAIRS];
};

stream make_stream(uint pixel)
{
    stream s;
    generator g = make_generator(pixel);
    s.mask = spp > 1u ? 0xffffffffu >> (31 - findMSB(spp - 1u)) : 0u;
    for (int pair = 0; pair < PAIRS; pair++) {
        s.order[pair] = next_number(g);
        s.shift[pair].x = next_number(g);
        s.shift[pair].y = next_number(g);
    }
    return s;
}

uint shuffled(uint index, uint seed)
{
    uint x = bitfieldReverse(index) + seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return bitfieldReverse(x);
}

uint sobol(uint index)
{
    uint value = 0u;
    for (uint v = 1u << 31; index != 0u; index >>= 1, v ^= v >> 1)
        value ^= (index & 1u) != 0u ? v : 0u;
    return value;
}

uvec2 stream_pair(stream s, int pair, uint index)
{
    uint place = shuffled(index, s.order[pair]) & s.mask;
    return uvec2(bitfieldReverse(place), sobol(place)) ^ s.shift[pair];
}

precise float unit_float(uint u)
{
    return float(u >> 8) * 5.96046448e-8;
}

// ---- Camera and frame (sphere.c) -----------------------------------------------------------------------------------

struct hit_point {
    vec3 tangent, bitangent, normal, wo;
};

// inside: what the place in the picture leaves to the outline, > 0.
precise hit_point sphere_hit(vec2 at, float inside)
{
    precise float root = sqrt(inside);
    precise vec2 p = at * scale;
    precise float r2 = p.x * p.x + p.y * p.y;
    precise float length2 = 1.0 + r2;
    precise float len = sqrt(length2);
    precise float t = (camera_distance - root) / length2;
    precise vec3 n = vec3(t * p.x, t * p.y, (camera_distance * r2 + root) / length2);
    precise float rho = sqrt(n.x * n.x + n.z * n.z);
    precise float tx = n.z / rho;
    precise float tz = -(n.x / rho);
    precise vec3 bitangent = vec3(n.y * tz, n.z * tx - n.x * tz, -(n.y * tx));
    precise vec3 wo =
        vec3(-(camera_distance * p.x) / (rho * len), -((1.0 + t * root) * p.y) / (rho * len), root / len);
    return hit_point(vec3(tx, 0.0, tz), bitangent, n, wo);
}

precise vec2 picture_place(uint pixel, uvec2 u)
{
    int column = int(pixel) % size, row = int(pixel) / size;
    return vec2(float(2 * column - size) + 2.0 * unit_float(u.x), float(size - 2 * row) - 2.0 * unit_float(u.y)) /
           float(size);
}

precise float dot3(vec3 a, vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

precise vec3 to_local(hit_point p, vec3 world)
{
    return vec3(dot3(world, p.tangent), dot3(world, p.bitangent), dot3(world, p.normal));
}

precise vec3 to_world(hit_point p, vec3 local)
{
    return local.x * p.tangent + local.y * p.bitangent + local.z * p.normal;
}

// ---- Environment (environment.c, turn.h) ---------------------------------------------------------------------------

// atan2(y, x) / (2 pi) in [0, 1].
precise float turn_of(float y, float x)
{
    float ax = abs(x), ay = abs(y);
    float low = ax < ay ? ax : ay, high = ax < ay ? ay : ax;
    precise float limit = 0.414213562 * high;
    bool wide = low > limit;
    precise float r = wide ? (low - high) / (low + high) : high > 0.0 ? low / high : 0.0;
    precise float r2 = r * r;
    precise float p = 0.0126946624;
    p = p * r2 - 0.0220405571;
    p = p * r2 + 0.0317897387;
    p = p * r2 - 0.0530507751;
    p = p * r2 + 0.159154937;
    precise float t = (wide ? 0.125 : 0.0) + r * p;
    t = ax < ay ? 0.25 - t : t;
    t = x < 0.0 ? 0.5 - t : t;
    return y < 0.0 ? 1.0 - t : t;
}

int texel(float place, int count)
{
    return place > 0.0 ? (place < float(count) ? int(place) : count - 1) : 0;
}

int texel_of(vec3 d)
{
    precise float radius = sqrt(d.x * d.x + d.z * d.z);
    precise float polar = 2.0 * turn_of(radius, d.y) * float(height);
    precise float around = (turn_of(d.x, -d.z) + turn) + 0.5;
    around = (around - floor(around)) * float(width);
    return texel(polar, height) * width + texel(around, width);
}

// place * count / 2^31
int cell(uint place, int count)
{
    uint high, low;
    umulExtended(place, uint(count), high, low);
    return int(high << 1 | low >> 31);
}

// To the nearest float, in two parts that are exact.
precise float whole(uint x)
{
    return float(x >> 12) * 4096.0 + float(x & 4095u);
}

// The entry of `count` from `base` on that a place belongs to; share: how far inside it lies.
int find(uint place, int base, int count, out float share)
{
    int index = base + int(places[base + cell(place, count)].y);
    uint end = places[index].x;
    while (end <= place)
        end = places[++index].x;
    uint before = index > base ? places[index - 1].x : 0u;
    precise float part = whole(place - before) / whole(end - before);
    share = part;
    return index - base;
}

precise vec3 direction_of(int row, int column, float down, float along)
{
    int mirrored = height - 1 - row;
    float upper = caps[row], lower = caps[row + 1];
    precise float cap, y;
    if (row == mirrored) {
        y = (1.0 - upper) * (1.0 - 2.0 * down);
        cap = 1.0 - abs(y);
    } else {
        cap = upper + (lower - upper) * down;
        y = row < mirrored ? 1.0 - cap : cap - 1.0;
    }
    precise float radius = sqrt(cap * (2.0 - cap));
    precise float around = ((float(column) + along) / float(width) + 0.5) - turn;
    vec2 sine_cosine = hnbrdf_sincos_turn(around - floor(around));
    return vec3(radius * sine_cosine.x, y, -(radius * sine_cosine.y));
}

vec3 sample_map(uvec2 u, out int number)
{
    float down, along;
    int row = find(u.x >> 1, 0, height, down);
    int column = find(u.y >> 1, height + row * width, width, along);
    number = row * width + column;
    return direction_of(row, column, down, along);
}

// ---- The estimator (shade.c) ---------------------------------------------------------------------------------------

// A direction, and the texel and density that it comes with; density 0: none.
struct drawn_direction {
    vec3 wi;
    int number;
    float density;
};

drawn_direction draw_light(hnbrdf_material m, hit_point p, uvec2 u)
{
    drawn_direction d;
    vec3 world = sample_map(u, d.number);
    d.wi = to_local(p, world);
    precise float density = texels[d.number].w;
    if (STRATEGY == STRATEGY_MIS && d.wi.z > 0.0)
        density = density + hnbrdf_pdf(m, d.wi, p.wo);
    d.density = d.wi.z > 0.0 ? density : 0.0;
    return d;
}

// One number for lobe and azimuth, as surface.c has it: pairs that are stratified stay so in each lobe.
drawn_direction draw_brdf(hnbrdf_material m, hit_point p, uvec2 u)
{
    drawn_direction d;
    precise float density =
        hnbrdf_sample_direction(m, p.wo, vec2(unit_float(u.x), unit_float(u.y)), d.wi);
    d.number = 0;
    d.density = density;
    if (!(density > 0.0))
        return d;
    d.number = texel_of(to_world(p, d.wi));
    if (STRATEGY == STRATEGY_MIS)
        density = texels[d.number].w + density;
    d.density = density;
    return d;
}

void record(uint at, vec3 wi, vec3 wo, vec3 f, bool counts)
{
    for (int k = 0; k < 3; k++) {
        results[at + k] = wi[k];
        results[at + 3 + k] = wo[k];
        results[at + 6 + k] = f[k];
    }
    results[at + 9] = counts ? 1.0 : 0.0;
}

// Adds to a sum kept in two parts, the second at most half an ulp of the first: a step loses at most 2^-47 of the sum
// (Knuth 1997, 4.2.2, theorem B; then Dekker 1971).
void add(inout vec3 high, inout vec3 low, vec3 value)
{
    precise vec3 sum = high + value;
    precise vec3 part = sum - high;
    precise vec3 lost = (high - (sum - part)) + (value - part);
    precise vec3 rest = low + lost;
    precise vec3 both = sum + rest;
    precise vec3 left = rest - (both - sum);
    high = both;
    low = left;
}

void main()
{
    uint invocation = gl_GlobalInvocationID.x;
    if (invocation >= pixels)
        return;
    uint pixel = first_pixel + invocation, at = 8u * invocation, rank = 0u; // rank: hits in this block
    bool fresh = RECORDS || first_sample == 0u;
    vec3 high = fresh ? vec3(0.0) : vec3(results[at], results[at + 1], results[at + 2]);
    vec3 low = fresh ? vec3(0.0) : vec3(results[at + 3], results[at + 4], results[at + 5]);
    float hits = fresh ? 0.0 : results[at + 6];
    int first_part = STRATEGY == STRATEGY_BRDF ? 1 : 0, last_part = STRATEGY == STRATEGY_LIGHT ? 0 : 1;
    hnbrdf_material m = hnbrdf_scene_material(0);
    stream s = make_stream(pixel);
    for (uint i = first_sample; i < first_sample + samples; i++) {
        uint begin = i & ~(BLOCK - 1u);
        rank = i == begin ? 0u : rank;
        vec2 place = picture_place(pixel, stream_pair(s, PAIR_LENS, i));
        precise float inside = 1.0 - frame2 * (place.x * place.x + place.y * place.y);
        if (!(inside > 0.0))
            continue;
        hit_point p = sphere_hit(place, inside);
        uint index = begin + rank;
        rank++;
        hits += 1.0;
        // The environment's direction, then the BRDF's; a loop, so that the network is there once.
        [[dont_unroll]] for (int part = first_part; part <= last_part; part++) {
            drawn_direction d;
            if (part == 0)
                d = draw_light(m, p, stream_pair(s, PAIR_LIGHT, index));
            else
                d = draw_brdf(m, p, stream_pair(s, PAIR_DIRECTION, index));
            bool counts = d.density > 0.0 && d.wi.z > 0.0;
            vec3 f = counts ? hnbrdf_eval(m, d.wi, p.wo) : vec3(0.0);
            if (RECORDS)
                record(10u * (2u * (invocation * samples + i - first_sample) + uint(part)), d.wi, p.wo, f, counts);
            precise vec3 factor = texels[d.number].rgb * d.wi.z / d.density;
            precise vec3 value = f * factor;
            if (counts)
                add(high, low, value);
        }
    }
    if (RECORDS)
        return;
    for (int k = 0; k < 3; k++) {
        results[at + k] = high[k];
        results[at + 3 + k] = low[k];
    }
    results[at + 6] = hits;
}
