/* brdf_network.c: read the network that is written out in the GLSL of a published .brdf file. */
#include "import/brdf_network.h"

#include "base/error.h"

#include <string.h>

enum { WIDTH = HNBRDF_BRDF_WIDTH, MAX_OPERAND = 32 };

/* Some neighbouring inputs or outputs of a layer that bear one name. */
typedef struct group {
    char name[MAX_OPERAND];
    int first, size;
} group;

typedef struct groups {
    group items[WIDTH];
    int count, total;
} groups;

typedef struct reading {
    hnbrdf_words *words;
    hnbrdf_brdf_network *network;
    hnbrdf_error *error;
    groups inputs, outputs; /* of the layer that is being read */
    int activated;          /* whether that layer has hardGeLU */
    int learning;           /* the first statement of all: its operands become the inputs */
} reading;

/* matCxR( or vecR( and its numbers, column by column. */
typedef struct block {
    int columns, rows;
    int is_matrix;
    float numbers[16];
} block;

static hnbrdf_result fail(const reading *r, const char *expected)
{
    return hnbrdf_words_fail(r->words, expected, r->error);
}

/* What is wrong when no single word is to blame. */
static hnbrdf_result fail_line(const reading *r, const char *message)
{
    return hnbrdf_fail(r->error, HNBRDF_ERROR_FORMAT, "%s: line %d: %s", r->words->file,
                       r->words->line, message);
}

/* ---- Names and constructors ------------------------------------------------------------------ */

/* vec2, mat3, mat2x4 and the like, with what they make. */
static int is_constructor(const hnbrdf_words *words, block *made)
{
    const char *name = words->begin;
    const size_t length = (size_t)(words->stop - words->begin);
    const int size = length >= 4 ? name[3] - '0' : 0;
    const int other = length == 6 && name[4] == 'x' ? name[5] - '0' : size;
    if (words->kind != HNBRDF_WORD_NAME || size < 2 || size > 4 || other < 2 || other > 4)
        return 0;
    made->is_matrix = memcmp(name, "mat", 3) == 0;
    made->columns = made->is_matrix ? size : 1;
    made->rows = other;
    return made->is_matrix ? length == 4 || length == 6
                           : length == 4 && memcmp(name, "vec", 3) == 0;
}

static hnbrdf_result read_block(reading *r, block *b)
{
    int count = 0;
    if (!is_constructor(r->words, b))
        return fail(r, "a matrix or vector of numbers");
    const int wanted = b->columns * b->rows;
    hnbrdf_words_next(r->words);
    if (!hnbrdf_words_take(r->words, "("))
        return fail(r, "'('");
    do {
        if (count == wanted)
            return fail(r, "')' after the last number of a matrix or vector");
        if (!hnbrdf_words_take_number(r->words, &b->numbers[count]))
            return fail(r, "a number");
        ++count;
    } while (hnbrdf_words_take(r->words, ","));
    if (!b->is_matrix && count == 1) /* one number for all */
        for (; count < wanted; ++count)
            b->numbers[count] = b->numbers[0];
    if (count < wanted)
        return fail(r, "',' and more numbers of a matrix or vector");
    return hnbrdf_words_take(r->words, ")") ? HNBRDF_OK : fail(r, "')'");
}

/* NAME or NAME.x */
static hnbrdf_result read_operand(reading *r, char name[MAX_OPERAND])
{
    size_t used = 0;
    for (int part = 0; part < 2; ++part) {
        const size_t length = (size_t)(r->words->stop - r->words->begin);
        if (r->words->kind != HNBRDF_WORD_NAME || used + length + 2 > MAX_OPERAND)
            return fail(r, "the name of a vector, up to 30 letters");
        memcpy(name + used, r->words->begin, length);
        used += length;
        hnbrdf_words_next(r->words);
        if (part == 1 || !hnbrdf_words_take(r->words, "."))
            break;
        name[used++] = '.';
    }
    name[used] = '\0';
    return HNBRDF_OK;
}

/* ---- Groups ---------------------------------------------------------------------------------- */

static const group *find(const groups *list, const char *name)
{
    for (int i = 0; i < list->count; ++i)
        if (strcmp(list->items[i].name, name) == 0)
            return &list->items[i];
    return NULL;
}

/* The group of this name, or the part of one that NAME.x selects. */
static int resolve(const groups *list, const char *name, int *first, int *size)
{
    static const char COMPONENTS[] = "xyzw";
    const group *whole = find(list, name);
    const char *point = strchr(name, '.');
    char base[MAX_OPERAND] = "";
    if (whole) {
        *first = whole->first;
        *size = whole->size;
        return 1;
    }
    if (!point || strlen(point) != 2 || !strchr(COMPONENTS, point[1]))
        return 0;
    memcpy(base, name, (size_t)(point - name));
    whole = find(list, base);
    const int component = (int)(strchr(COMPONENTS, point[1]) - COMPONENTS);
    if (!whole || component >= whole->size)
        return 0;
    *first = whole->first + component;
    *size = 1;
    return 1;
}

static hnbrdf_result fail_width(const reading *r)
{
    return hnbrdf_fail(
        r->error, HNBRDF_ERROR_LIMIT,
        "%s: line %d: found one more input or output of a layer, expected at most %d",
        r->words->file, r->words->line, WIDTH);
}

static hnbrdf_result append(reading *r, groups *list, const char *name, int size)
{
    if (list->total + size > WIDTH)
        return fail_width(r);
    group *added = &list->items[list->count++];
    memcpy(added->name, name, MAX_OPERAND);
    added->first = list->total;
    added->size = size;
    list->total += size;
    return HNBRDF_OK;
}

/* ---- Statements ------------------------------------------------------------------------------ */

/* One statement while it is read: some rows of a layer. */
typedef struct rows {
    int count; /* 0 until the first block tells */
    int first; /* output of the layer, -1 until the first operand tells which layer it is */
    int activated, has_bias;
    int covered; /* inputs that were multiplied */
    unsigned char seen[WIDTH];
    float bias[4];
} rows;

/* The outputs of the layer before are the inputs of this one. */
static hnbrdf_result start_layer(reading *r)
{
    hnbrdf_brdf_network *n = r->network;
    if (n->layers > 0 && !r->activated) {
        return fail_line(r,
                         "the layer before has no hardGeLU, expected it around all but the last");
    }
    if (n->layers == HNBRDF_BRDF_LAYERS) {
        return hnbrdf_fail(r->error, HNBRDF_ERROR_LIMIT,
                           "%s: line %d: found one more layer, expected at most %d hidden ones",
                           r->words->file, r->words->line, HNBRDF_MAX_LAYERS);
    }
    r->inputs = r->outputs;
    memset(&r->outputs, 0, sizeof r->outputs);
    n->inputs[n->layers++] = r->inputs.total;
    return HNBRDF_OK;
}

/* Decides by its first operand which layer a statement belongs to. */
static hnbrdf_result place(reading *r, rows *s, const char *operand)
{
    int first, size;
    const int is_start = r->network->layers == 0;
    if (is_start || resolve(&r->outputs, operand, &first, &size)) {
        const hnbrdf_result result = start_layer(r);
        if (result)
            return result;
        r->learning = is_start;
    }
    s->first = r->outputs.total;
    return s->first + s->count <= WIDTH ? HNBRDF_OK : fail_width(r);
}

static hnbrdf_result multiply(reading *r, rows *s, const block *b, const char *operand,
                              int negative)
{
    hnbrdf_result result;
    int first = 0, size = 0;
    if (s->first < 0 && (result = place(r, s, operand)))
        return result;
    if (r->learning && !find(&r->inputs, operand) &&
        (result = append(r, &r->inputs, operand, b->columns)))
        return result;
    if (!resolve(&r->inputs, operand, &first, &size) || size != b->columns ||
        memchr(s->seen + first, 1, (size_t)size)) {
        return hnbrdf_fail(
            r->error, HNBRDF_ERROR_FORMAT,
            "%s: line %d: %d columns are multiplied by %s, expected every output of the "
            "layer before once",
            r->words->file, r->words->line, b->columns, operand);
    }
    float *weights = r->network->weights[r->network->layers - 1];
    for (int c = 0; c < b->columns; ++c) {
        s->seen[first + c] = 1;
        for (int i = 0; i < b->rows; ++i) {
            const float number = b->numbers[c * b->rows + i];
            weights[(s->first + i) * WIDTH + first + c] = negative ? -number : number;
        }
    }
    s->covered += b->columns;
    return HNBRDF_OK;
}

static hnbrdf_result add_bias(reading *r, rows *s, const block *b, int negative)
{
    if (b->is_matrix || s->has_bias) {
        return fail(r,
                    b->is_matrix ? "'*' after a matrix" : "'*' after a second vector of numbers");
    }
    s->has_bias = 1;
    for (int i = 0; i < b->rows; ++i)
        s->bias[i] = negative ? -b->numbers[i] : b->numbers[i];
    return HNBRDF_OK;
}

/* block * OPERAND, OPERAND * column, or the bias. */
static hnbrdf_result read_term(reading *r, rows *s, int negative)
{
    char operand[MAX_OPERAND] = "";
    block b = {0};
    hnbrdf_result result;
    const int operand_first = !is_constructor(r->words, &b);
    if (operand_first) {
        if ((result = read_operand(r, operand)))
            return result;
        if (!hnbrdf_words_take(r->words, "*"))
            return fail(r, "'*'");
    }
    if ((result = read_block(r, &b)))
        return result;
    if (operand_first && b.is_matrix)
        return fail_line(r, "a matrix stands behind its vector, expected it before");
    if (s->count != 0 && s->count != b.rows)
        return fail_line(r, "a term has more or fewer rows than those before, expected the same");
    s->count = b.rows;
    if (!operand_first && !hnbrdf_words_take(r->words, "*"))
        return add_bias(r, s, &b, negative);
    if (!operand_first && (result = read_operand(r, operand)))
        return result;
    return multiply(r, s, &b, operand, negative);
}

static hnbrdf_result read_sum(reading *r, rows *s)
{
    do {
        int negative = 0;
        while (hnbrdf_words_at(r->words, "+") || hnbrdf_words_at(r->words, "-")) {
            negative ^= hnbrdf_words_at(r->words, "-");
            hnbrdf_words_next(r->words);
        }
        const hnbrdf_result result = read_term(r, s, negative);
        if (result)
            return result;
    } while (hnbrdf_words_at(r->words, "+") || hnbrdf_words_at(r->words, "-"));
    return HNBRDF_OK;
}

/* hardGeLU in any mixture of cases. */
static int is_activation(const hnbrdf_words *words)
{
    static const char NAME[] = "hardgelu";
    const size_t length = (size_t)(words->stop - words->begin);
    if (words->kind != HNBRDF_WORD_NAME || length != sizeof NAME - 1)
        return 0;
    for (size_t i = 0; i < length; ++i)
        if ((words->begin[i] | 0x20) != NAME[i])
            return 0;
    return 1;
}

/* hardGeLU( if it is there; no other function. */
static hnbrdf_result take_activation(reading *r, int *activated)
{
    hnbrdf_words ahead = *r->words;
    block unused;
    *activated = 0;
    hnbrdf_words_next(&ahead);
    if (r->words->kind != HNBRDF_WORD_NAME || is_constructor(r->words, &unused) ||
        !hnbrdf_words_take(&ahead, "("))
        return HNBRDF_OK;
    if (!is_activation(r->words))
        return fail(r, "hardGeLU as the activation");
    *r->words = ahead;
    *activated = 1;
    return HNBRDF_OK;
}

/* Enters the finished rows into their layer. */
static hnbrdf_result finish_rows(reading *r, const rows *s, const char *name)
{
    hnbrdf_brdf_network *n = r->network;
    if (s->first < 0 || s->covered != r->inputs.total) {
        return hnbrdf_fail(r->error, HNBRDF_ERROR_FORMAT,
                           "%s: line %d: %s multiplies %d inputs, expected all %d of its layer",
                           r->words->file, r->words->line, name, s->covered, r->inputs.total);
    }
    if (r->outputs.count > 0 && s->activated != r->activated)
        return fail_line(r, "some rows of a layer are in hardGeLU, expected all or none");
    r->learning = 0;
    r->activated = s->activated;
    memcpy(&n->biases[n->layers - 1][s->first], s->bias, (size_t)s->count * sizeof(float));
    n->inputs[n->layers - 1] = r->inputs.total;
    n->outputs[n->layers - 1] = s->first + s->count;
    return append(r, &r->outputs, name, s->count);
}

static hnbrdf_result read_statement(reading *r)
{
    rows s = {.first = -1};
    char name[MAX_OPERAND] = "";
    hnbrdf_result result;
    do { /* const vec4 NAME */
        if ((result = read_operand(r, name)))
            return result;
    } while (!hnbrdf_words_take(r->words, "="));
    if ((result = take_activation(r, &s.activated)) || (result = read_sum(r, &s)))
        return result;
    if (s.activated && !hnbrdf_words_take(r->words, ")"))
        return fail(r, "'+', '-' or ')' of hardGeLU");
    if (!hnbrdf_words_at(r->words, ";"))
        return fail(r, "'+', '-' or ';'");
    return finish_rows(r, &s, name);
}

/* ---- Function body --------------------------------------------------------------------------- */

static int ends_statement(const hnbrdf_words *words)
{
    return words->kind == HNBRDF_WORD_END || hnbrdf_words_at(words, ";") ||
           hnbrdf_words_at(words, "{") || hnbrdf_words_at(words, "}");
}

/* Whether hardGeLU or a matrix of numbers stands in the statement that begins here; moves to its
 * end. */
static int skip_statement(hnbrdf_words *words)
{
    int found = 0;
    while (!ends_statement(words)) {
        block b;
        const int is_matrix = is_constructor(words, &b) && b.is_matrix;
        found |= is_activation(words);
        hnbrdf_words_next(words);
        if (is_matrix && hnbrdf_words_take(words, "(")) {
            found |= words->kind == HNBRDF_WORD_NUMBER || hnbrdf_words_at(words, "-") ||
                     hnbrdf_words_at(words, "+");
        }
    }
    return found;
}

static hnbrdf_result read_body(reading *r)
{
    for (int depth = 1; depth > 0;) {
        hnbrdf_words ahead = *r->words;
        if (ahead.kind == HNBRDF_WORD_END)
            return fail(r, "'}' at the end of mlp_eval");
        if (skip_statement(&ahead)) {
            const hnbrdf_result result = read_statement(r);
            if (result)
                return result;
            ahead = *r->words;
        }
        depth += hnbrdf_words_at(&ahead, "{") - hnbrdf_words_at(&ahead, "}");
        if (ahead.kind != HNBRDF_WORD_END)
            hnbrdf_words_next(&ahead);
        *r->words = ahead;
    }
    return HNBRDF_OK;
}

/* From rows of WIDTH numbers to dense ones, in place. */
static void make_dense(hnbrdf_brdf_network *n)
{
    for (int k = 0; k < n->layers; ++k) {
        const size_t inputs = (size_t)n->inputs[k];
        for (int row = 1; row < n->outputs[k]; ++row) {
            memmove(n->weights[k] + (size_t)row * inputs, n->weights[k] + row * WIDTH,
                    inputs * sizeof(float));
        }
    }
}

hnbrdf_result hnbrdf_brdf_read_network(hnbrdf_words *words, hnbrdf_brdf_network *network,
                                       hnbrdf_error *error)
{
    reading r = {.words = words, .network = network, .error = error};
    memset(network, 0, sizeof *network);
    const hnbrdf_result result = read_body(&r);
    if (result)
        return result;
    if (network->layers == 0 || r.activated) {
        return hnbrdf_fail(
            error, HNBRDF_ERROR_FORMAT,
            "%s: line %d: mlp_eval ends with %s, expected a last layer without hardGeLU",
            words->file, words->line, network->layers ? "a layer in hardGeLU" : "no layer at all");
    }
    make_dense(network);
    return HNBRDF_OK;
}
