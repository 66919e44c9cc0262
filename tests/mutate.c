/* mutate.c: lists the small changes that tests/mutants.sh makes to a C file, and makes one of them.
 *
 *   mutate list SEED FILE      one line a change: number, order, line, before, after, text
 *   mutate apply NUMBER FILE   the file with that change, to standard output
 *   mutate switch 0 FILE       the file with many changes that a variable switches on; which ones:
 *                              lines of `number id` from standard input
 *
 * The fields of a list are separated by tabs; `order` is a number made from seed and change, to
 * choose some of them by. A change is one token: a comparison, an operator, a sign, a constant; or
 * one statement that is left out. Comments, strings, lines of the preprocessor, messages,
 * assertions and the insides of struct and attribute are left alone. Binary operators are told from
 * pointers and signs by the blanks around them, which clang-format puts. */
#include <ctype.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_TOKENS = 1 << 18, MOST_DEPTH = 256, MOST_TEXT = 1 << 22, MOST_WORD = 64 };

typedef struct token {
    size_t at, size;
    char kind;          /* i name, n number, s string, p punctuation */
    char spaced;        /* blanks on both sides */
    char off;           /* not to be changed */
    char in_code;       /* within the body of a function */
    char starts;        /* a statement */
    char ends_head;     /* the ) of if (...), for (...), while (...), switch (...) */
    char ends_label;    /* the : of case and default */
    char declares_size; /* the number in float x[3] */
} token;

static char text[MOST_TEXT];
static size_t length;
static token tokens[MOST_TOKENS + 1];
static size_t count;

static int is(size_t k, const char *word)
{
    return k < count && tokens[k].size == strlen(word) &&
           !memcmp(text + tokens[k].at, word, tokens[k].size);
}

static int is_any(size_t k, const char *const *words)
{
    for (; *words; words++)
        if (is(k, *words))
            return 1;
    return 0;
}

/* ---- Tokens ---------------------------------------------------------------------------------- */

static size_t skip_quoted(size_t at)
{
    char quote = text[at++];
    while (at < length && text[at] != quote)
        at += text[at] == '\\' ? 2 : 1;
    return at + 1;
}

static size_t skip_number(size_t at)
{
    while (isalnum((unsigned char)text[at]) || text[at] == '.' ||
           ((text[at] == '+' || text[at] == '-') && strchr("eEpP", text[at - 1]) &&
            !(text[at - 1] == 'e' && strchr("xX", text[at - 2]))))
        at++;
    return at;
}

static size_t operator_size(size_t at)
{
    static const char *const operators[] = {"<<=", ">>=", "...", "->", "++", "--", "<<", ">>",
                                            "<=",  ">=",  "==",  "!=", "&&", "||", "+=", "-=",
                                            "*=",  "/=",  "%=",  "&=", "|=", "^=", NULL};
    for (const char *const *o = operators; *o; o++)
        if (!strncmp(text + at, *o, strlen(*o)))
            return strlen(*o);
    return 1;
}

static void add_token(size_t at, size_t end, char kind)
{
    if (count == MOST_TOKENS) {
        fprintf(stderr, "mutate: more than %d tokens\n", (int)MOST_TOKENS);
        exit(2);
    }
    token t = {.at = at, .size = end - at, .kind = kind};
    t.spaced = at > 0 && isspace((unsigned char)text[at - 1]) && isspace((unsigned char)text[end]);
    tokens[count++] = t;
}

static void split(void)
{
    int fresh = 1; /* nothing but blanks on this line so far */
    for (size_t at = 0; at < length;) {
        size_t end = at + 1;
        char c = text[at];
        if (c == '\n') {
            fresh = 1;
        } else if (isspace((unsigned char)c)) {
        } else if (c == '#' && fresh) {
            while (end < length && (text[end] != '\n' || text[end - 1] == '\\'))
                end++;
        } else if (c == '/' && text[at + 1] == '*') {
            const char *close = strstr(text + at + 2, "*/");
            end = close ? (size_t)(close - text) + 2 : length;
        } else if (c == '/' && text[at + 1] == '/') {
            while (end < length && text[end] != '\n')
                end++;
        } else {
            fresh = 0;
            char kind = 'p';
            if (c == '"' || c == '\'') {
                kind = 's';
                end = skip_quoted(at);
            } else if (isdigit((unsigned char)c) ||
                       (c == '.' && isdigit((unsigned char)text[at + 1]))) {
                kind = 'n';
                end = skip_number(at);
            } else if (isalpha((unsigned char)c) || c == '_') {
                kind = 'i';
                while (isalnum((unsigned char)text[end]) || text[end] == '_')
                    end++;
            } else {
                end = at + operator_size(at);
            }
            add_token(at, end, kind);
        }
        at = end;
    }
}

/* ---- Structure ------------------------------------------------------------------------------- */

static const char *const quiet_calls[] = {
    "assert",      "static_assert",      "_Static_assert", "__attribute__",
    "hnbrdf_fail", "hnbrdf_fail_memory", "sizeof",         "print_message",
    "fprintf",     "_Alignas",           "UINT64_C",       "INT64_C",
    NULL};
static const char *const not_expressions[] = {
    "return", "goto",   "case",     "default",  "if",    "for",    "while",
    "do",     "switch", "else",     "struct",   "union", "enum",   "const",
    "static", "extern", "typedef",  "int",      "float", "double", "unsigned",
    "char",   "size_t", "uint32_t", "register", NULL};

static size_t closing(size_t k, const char *open, const char *close)
{
    int depth = 0;
    for (; k < count; k++) {
        depth += is(k, open) - is(k, close);
        if (depth == 0)
            return k;
    }
    return count;
}

static void silence(size_t from, size_t to)
{
    for (size_t k = from; k <= to && k < count; k++)
        tokens[k].off = 1;
}

static int is_declaration(size_t k)
{
    static const char *const stars[] = {"*", "const", NULL};
    if (is(k, "const") || is(k, "static") || is(k, "extern") || is(k, "typedef"))
        return 1;
    if (tokens[k].kind != 'i' || is(k, "return") || is(k, "goto") || is(k, "else") || is(k, "case"))
        return 0;
    if (is(k, "struct") || is(k, "union") || is(k, "enum"))
        return 1;
    return k + 1 < count && (tokens[k + 1].kind == 'i' || is_any(k + 1, stars));
}

/* The sizes of the arrays that the declaration from k on declares. */
static void mark_sizes(size_t k)
{
    int valued = 0, depth = 0;
    for (; k < count && !(depth == 0 && (is(k, ";") || is(k, "{"))); k++) {
        if (is(k, "("))
            depth++;
        else if (is(k, ")"))
            depth--;
        else if (is(k, "{"))
            break;
        else if (is(k, "="))
            valued = 1;
        else if (is(k, ",") && depth == 0)
            valued = 0;
        else if (is(k, "[") && !valued)
            for (size_t end = closing(k, "[", "]"); k < end; k++)
                tokens[k].declares_size = 1;
    }
}

/* Braces are of code (a body or a block), of a struct, or of values. */
static void find_structure(void)
{
    char kinds[MOST_DEPTH] = {'f'}; /* f file, c code, s struct, v values */
    static const char *const heads[] = {"if", "for", "while", "switch", NULL};
    int depth = 0, round_depth = 0, in_label = 0;
    for (size_t k = 0; k < count; k++) {
        if (is_any(k, quiet_calls) && is(k + 1, "("))
            silence(k, closing(k + 1, "(", ")"));
        if (is_any(k, heads) && is(k + 1, "("))
            tokens[closing(k + 1, "(", ")")].ends_head = 1;
        in_label |= is(k, "case") || is(k, "default");
        tokens[k].ends_label = (char)(in_label && is(k, ":"));
        in_label &= !is(k, ":");
        round_depth += is(k, "(") - is(k, ")");
        if (is(k, "{") && depth + 1 < MOST_DEPTH) {
            char kind = 'v';
            int typed = k > 0 && tokens[k - 1].kind == 'i';
            if (k > 0 && (is(k - 1, "struct") || is(k - 1, "union") ||
                          (typed && k > 1 && (is(k - 2, "struct") || is(k - 2, "union")))))
                kind = 's';
            else if (k > 0 &&
                     (is(k - 1, ")") || is(k - 1, "else") || is(k - 1, "do") ||
                      (kinds[depth] == 'c' &&
                       (is(k - 1, ";") || is(k - 1, "{") || is(k - 1, "}") || is(k - 1, ":")))) &&
                     round_depth == 0)
                kind = 'c';
            kinds[++depth] = kind;
        } else if (is(k, "}") && depth > 0) {
            depth--;
        }
        token *t = &tokens[k];
        for (int d = 0; d <= depth; d++)
            if (kinds[d] == 's')
                t->off = 1;
        t->in_code = kinds[depth] == 'c';
        if (depth == 0 && round_depth > 0) /* parameters */
            t->off = 1;
        int begins = k == 0 || is(k - 1, ";") || is(k - 1, "{") || is(k - 1, "}") ||
                     is(k - 1, "else") || is(k - 1, "do") || tokens[k - 1].ends_label ||
                     tokens[k - 1].ends_head;
        if (begins && round_depth == 0 && (t->in_code || depth == 0) && !is(k, "{")) {
            t->starts = 1;
            if (is_declaration(k))
                mark_sizes(k);
        } else if (begins && is(k - 1, "(") == 0 && round_depth == 1 && k > 1 && is(k - 2, "for"))
            if (is_declaration(k))
                mark_sizes(k);
    }
}

/* ---- Changes --------------------------------------------------------------------------------- */

typedef struct change {
    size_t at, size; /* of what is replaced */
    char after[MOST_WORD];
} change;

static change changes[MOST_TOKENS];
static size_t change_count;

static void add_change(size_t at, size_t size, const char *after)
{
    if (change_count == MOST_TOKENS || strlen(after) >= MOST_WORD)
        return;
    changes[change_count].at = at;
    changes[change_count].size = size;
    strcpy(changes[change_count++].after, after);
}

static const char *const swaps[][2] = {
    {"<", "<="},  {"<", ">="},  {"<=", "<"},  {">", ">="},  {">", "<="},  {">=", ">"}, {"==", "!="},
    {"!=", "=="}, {"+", "-"},   {"-", "+"},   {"*", "/"},   {"/", "*"},   {"%", "*"},  {"+=", "-="},
    {"-=", "+="}, {"*=", "/="}, {"/=", "*="}, {"&&", "||"}, {"||", "&&"}, {"&", "|"},  {"|", "&"},
    {"^", "&"},   {"<<", ">>"}, {">>", "<<"}, {"|=", "&="}, {"&=", "|="}};

static void change_operator(size_t k)
{
    const token *t = &tokens[k];
    for (size_t s = 0; s < sizeof swaps / sizeof swaps[0]; s++)
        if (t->spaced && is(k, swaps[s][0]))
            add_change(t->at, t->size, swaps[s][1]);
    int before = k > 0 && (tokens[k - 1].kind != 'p' || is(k - 1, ")") || is(k - 1, "]"));
    if (is(k, "-") && !t->spaced && (!before || is(k - 1, "return") || is(k - 1, ")")))
        add_change(t->at, t->size, "+");
    if (is(k, "!") || is(k, "~"))
        add_change(t->at, t->size, "");
}

/* n + 1; a number with a point 5 % larger, or 1 where it was 0. */
static void change_number(size_t k)
{
    const token *t = &tokens[k];
    char word[MOST_WORD], after[2 * MOST_WORD];
    if (t->declares_size || t->size >= 40)
        return;
    memcpy(word, text + t->at, t->size);
    word[t->size] = 0;
    int hexadecimal = word[0] == '0' && (word[1] == 'x' || word[1] == 'X');
    int whole = hexadecimal ? !strpbrk(word, "pP.") : !strpbrk(word, ".eE");
    if (whole)
        snprintf(after, sizeof after, "(%s + 1)", word);
    else if (strtod(word, NULL) == 0.0)
        snprintf(after, sizeof after, "1%s", strpbrk(word, "fF") && !hexadecimal ? ".0f" : ".0");
    else
        snprintf(after, sizeof after, "(%s * 1.05%s)", word, word[t->size - 1] == 'f' ? "f" : "");
    add_change(t->at, t->size, after);
}

static void drop_statement(size_t k)
{
    int skip = is(k, "break") || is(k, "continue");
    if (!tokens[k].in_code ||
        (tokens[k].kind != 'i' && !is(k, "*") && !is(k, "(") && !is(k, "++")) ||
        (!skip && (is_any(k, not_expressions) || is_declaration(k))))
        return;
    size_t end = k;
    int depth = 0;
    for (; end < count && !(depth == 0 && is(end, ";")); end++)
        depth += is(end, "(") + is(end, "{") - is(end, ")") - is(end, "}");
    if (end == count || is(k + 1, ":") || (is(k, "(") && is(k + 1, "void")))
        return;
    add_change(tokens[k].at, tokens[end].at - tokens[k].at, "");
}

static void find_changes(void)
{
    for (size_t k = 0; k < count; k++) {
        const token *t = &tokens[k];
        if (t->starts && !t->off)
            drop_statement(k);
        if (t->off)
            continue;
        if (t->kind == 'n')
            change_number(k);
        else if (t->kind == 'p')
            change_operator(k);
    }
}

/* ---- Switches -------------------------------------------------------------------------------- */

/* Many changes in one build, each made where the variable hnbrdf_mutant has its number: the text
 * then only gets something before and behind a span. Macros are in tests/mutant.h. What stands in
 * constants, sizes and labels, and operators of bits and truth, cannot be switched like this. */
typedef struct span {
    size_t from, to; /* of the text */
    char open[3 * MOST_WORD], close[MOST_WORD];
    int replaces; /* 1: open stands for the text from..to */
} span;

static span spans[MOST_TOKENS];
static size_t span_count;

static span *add_span(size_t from, size_t to)
{
    span *s = &spans[span_count++];
    *s = (span){.from = from, .to = to};
    return s;
}

static size_t end_of(size_t k)
{
    return tokens[k].at + tokens[k].size;
}

static const char *const ends[] = {
    "&&", "||", "?",  ":",  ",",  ";",  "=",  "==",     "!=",   "&",  "|",    "^", "+=",
    "-=", "*=", "/=", "%=", "&=", "|=", "^=", "return", "else", "do", "case", NULL};
static const char *const opening[] = {"(", "[", "{", NULL}, *const close_any[] = {")", "]", "}",
                                                                                  NULL};

/* The first or last token of the operand that ends or begins beside token k. */
static size_t operand_first(size_t k)
{
    int depth = 0;
    for (; k > 0; k--) {
        if (depth == 0 && (is_any(k - 1, ends) || is_any(k - 1, opening)))
            break;
        depth += is_any(k - 1, close_any) - is_any(k - 1, opening);
    }
    return k;
}

static size_t operand_last(size_t k, const char *const *stops)
{
    int depth = 0;
    for (; k + 1 < count; k++) {
        if (depth == 0 && (is_any(k + 1, stops) || is_any(k + 1, close_any)))
            break;
        depth += is_any(k + 1, opening) - is_any(k + 1, close_any);
    }
    return k;
}

/* The last token of the number, name, call or parentheses that begin at k; 0 for others. */
static size_t factor_last(size_t k)
{
    while (is(k, "-") || is(k, "!"))
        k++;
    if (is(k, "(")) {
        k = closing(k, "(", ")");
        if (k + 1 < count && (tokens[k + 1].kind != 'p' || is(k + 1, "("))) /* a cast */
            return factor_last(k + 1);
    } else if (tokens[k].kind == 'p' || is(k, "sizeof")) {
        return 0;
    }
    for (;;)
        if (is(k + 1, "."))
            k += 2;
        else if (is(k + 1, "->"))
            k += 2;
        else if (is(k + 1, "["))
            k = closing(k + 1, "[", "]");
        else if (is(k + 1, "("))
            k = closing(k + 1, "(", ")");
        else
            return k;
}

static int switch_comparison(size_t k, const change *c, int id)
{
    static const char *const names[][2] = {{"<", "LT"},  {">", "GT"},  {"<=", "LE"},
                                           {">=", "GE"}, {"==", "EQ"}, {"!=", "NE"}};
    static const char *const stops[] = {"&&", "||", "?", ":",  ",",  ";",  "&",  "|",
                                        "^",  "<",  ">", "<=", ">=", "==", "!=", NULL};
    for (size_t n = 0; n < sizeof names / sizeof names[0]; n++) {
        if (!is(k, names[n][0]))
            continue;
        size_t first = operand_first(k), last = operand_last(k, stops);
        int negates = strlen(c->after) == 2 && (n < 2 ? c->after[0] != names[n][0][0] : n > 3);
        span *s = add_span(tokens[first].at, end_of(last));
        snprintf(s->open, sizeof s->open, "MUTANT_%s_%s(", names[n][1], negates ? "NOT" : "EDGE");
        snprintf(s->close, sizeof s->close, ", %d)", id);
        s = add_span(tokens[k].at, end_of(k));
        s->replaces = 1;
        strcpy(s->open, ",");
        return 1;
    }
    return 0;
}

static int switch_operator(size_t k, int id)
{
    static const char *const stops[] = {",", ";", NULL};
    size_t last = is(k, "*") || is(k, "/") ? factor_last(k + 1) : operand_last(k, stops);
    span *s;
    if (is(k, "!") && !is(k - 1, "==") && !is(k - 1, "!=")) {
        s = add_span(tokens[k].at, end_of(k));
        snprintf(s->open, sizeof s->open, "(hnbrdf_mutant != %d) == !", id);
    } else if ((is(k, "+") || is(k, "-")) && tokens[k].spaced) {
        s = add_span(tokens[k].at, end_of(k));
        snprintf(s->open, sizeof s->open, "%c (hnbrdf_mutant == %d ? -1 : 1) *", text[tokens[k].at],
                 id);
    } else if (is(k, "-") && !is(k - 1, "*") && !is(k - 1, "/") && !is(k - 1, "%")) {
        s = add_span(tokens[k].at, end_of(k));
        snprintf(s->open, sizeof s->open, "(hnbrdf_mutant == %d ? 1 : -1) *", id);
    } else if (is(k, "+=") || is(k, "-=")) {
        s = add_span(tokens[k + 1].at, end_of(last));
        snprintf(s->open, sizeof s->open, "(hnbrdf_mutant == %d ? -1 : 1) * (", id);
        strcpy(s->close, ")");
        return 1;
    } else if ((is(k, "*") || is(k, "/") || is(k, "*=") || is(k, "/=")) && last > 0) {
        s = add_span(tokens[k + 1].at, end_of(last));
        strcpy(s->open, "MUTANT_INVERSE(");
        snprintf(s->close, sizeof s->close, ", %d)", id);
        return 1;
    } else {
        return 0;
    }
    s->replaces = 1;
    return 1;
}

/* Constants, labels and what only one change of a comparison can have. */
static int is_fixed(size_t k)
{
    size_t start = k;
    if (!tokens[k].in_code || tokens[k].declares_size || tokens[k].off)
        return 1;
    while (start > 0 && !tokens[start].starts)
        start--;
    return is(start, "static") || is(start, "enum") || is(start, "case");
}

static int switch_change(const change *c, int id)
{
    size_t k = 0;
    while (k < count && tokens[k].at != c->at)
        k++;
    if (k == count || k == 0 || is_fixed(k))
        return 0;
    if (c->size > tokens[k].size) { /* a statement */
        if (tokens[k].kind != 'i' && !is(k, "*"))
            return 0;
        span *s = add_span(c->at, c->at + c->size);
        snprintf(s->open, sizeof s->open, "hnbrdf_mutant == %d ? (void)0 : (void)(", id);
        strcpy(s->close, ")");
        return 1;
    }
    if (tokens[k].kind == 'n') {
        span *s = add_span(c->at, c->at + c->size);
        snprintf(s->open, sizeof s->open, "(hnbrdf_mutant == %d ? %s : %.*s)", id, c->after,
                 (int)c->size, text + c->at);
        s->replaces = 1;
        return 1;
    }
    return tokens[k].kind == 'p' && (switch_comparison(k, c, id) || switch_operator(k, id));
}

/* Wider spans open first and close last. */
static int by_start(const void *a, const void *b)
{
    const span *x = a, *y = b;
    if (x->from != y->from)
        return x->from < y->from ? -1 : 1;
    return x->to > y->to ? -1 : x->to < y->to;
}

static void print_switched(void)
{
    static size_t open[MOST_TOKENS];
    size_t depth = 0, next = 0;
    qsort(spans, span_count, sizeof spans[0], by_start);
    for (size_t at = 0; at <= length; at++) {
        while (depth > 0 && spans[open[depth - 1]].to == at)
            fputs(spans[open[--depth]].close, stdout);
        size_t skip = 0;
        for (; next < span_count && spans[next].from == at; next++) {
            fputs(spans[next].open, stdout);
            if (spans[next].replaces)
                skip = spans[next].to - at;
            else
                open[depth++] = next;
        }
        if (skip > 0) {
            at += skip - 1;
            continue;
        }
        if (at < length)
            putchar(text[at]);
    }
}

/* Lines of `number id` from standard input; those that cannot be switched go to standard error. At
 * most one change a token. */
static void switch_all(void)
{
    static char taken[MOST_TEXT];
    unsigned long number;
    int id;
    while (scanf("%lu %d", &number, &id) == 2)
        if (number < change_count && !taken[changes[number].at] &&
            switch_change(&changes[number], id))
            taken[changes[number].at] = 1;
        else
            fprintf(stderr, "%lu\n", number);
    print_switched();
}

/* ---- Program --------------------------------------------------------------------------------- */

static uint64_t mix(uint64_t h, uint64_t value)
{
    h = (h ^ value) * UINT64_C(0x9e3779b97f4a7c15);
    return h ^ h >> 29;
}

/* Blanks and line ends as one blank. */
static void print_flat(const char *from, size_t size)
{
    int blank = 0;
    for (size_t i = 0; i < size; i++) {
        blank |= isspace((unsigned char)from[i]) != 0;
        if (isspace((unsigned char)from[i]))
            continue;
        if (blank && i > 0)
            putchar(' ');
        blank = 0;
        putchar(from[i]);
    }
}

static void print_list(uint64_t seed, const char *path)
{
    uint64_t name = seed;
    for (const char *c = path; *c; c++)
        name = mix(name, (unsigned char)*c);
    for (size_t k = 0; k < change_count; k++) {
        const change *c = &changes[k];
        size_t line = 1, start = c->at, end = c->at;
        for (size_t i = 0; i < c->at; i++)
            line += text[i] == '\n';
        while (start > 0 && text[start - 1] != '\n')
            start--;
        while (start < c->at && isspace((unsigned char)text[start]))
            start++;
        while (end < length && text[end] != '\n')
            end++;
        printf("%zu\t%08x\t%zu\t", k, (unsigned)(mix(mix(name, k), k + 1) >> 32), line);
        print_flat(text + c->at, c->size);
        printf("\t%s\t", c->after[0] ? c->after : "(dropped)");
        print_flat(text + start, end - start);
        putchar('\n');
    }
}

int main(int argc, char **argv)
{
    FILE *file = argc == 4 ? fopen(argv[3], "rb") : NULL;
    if (!file ||
        (strcmp(argv[1], "list") && strcmp(argv[1], "apply") && strcmp(argv[1], "switch"))) {
        fprintf(stderr, "usage: mutate list SEED FILE | mutate apply NUMBER FILE | "
                        "mutate switch 0 FILE\n");
        return 2;
    }
    length = fread(text, 1, MOST_TEXT - 8, file);
    fclose(file);
    split();
    find_structure();
    find_changes();
    unsigned long long number = strtoull(argv[2], NULL, 10);
    if (!strcmp(argv[1], "list")) {
        print_list(number, argv[3]);
        return 0;
    }
    if (!strcmp(argv[1], "switch")) {
        switch_all();
        return 0;
    }
    if (number >= change_count) {
        fprintf(stderr, "mutate: change %llu, expected 0 to %zu\n", number, change_count - 1);
        return 2;
    }
    const change *c = &changes[number];
    fwrite(text, 1, c->at, stdout);
    fputs(c->after, stdout);
    fwrite(text + c->at + c->size, 1, length - c->at - c->size, stdout);
    return 0;
}
