# amalgamate.awk: joins C files and the headers of their own into one C file.
#
#   awk -v root=DIR -f src/amalgamate.awk TEMPLATE FILE... > hnbrdf.c
#
# TEMPLATE and FILE... are relative to DIR or absolute. TEMPLATE is printed as it is, but for these
# lines: SOURCES, where the files go; SYSTEM_HEADERS, where what they include of the system goes,
# unless it is under a condition; and KERNEL NAME, KERNEL_TEXT, KERNEL_END: what is between them is
# printed before and after core/kernel_NAME.c.
#
# Headers of ours come first, in an order that serves; one without an include guard is text of the
# file that includes it. A file-scope name that several files have (static functions, types,
# constants) gets room and file before it in all of them but headers; what a file defines for the
# preprocessor ends with it. TEMPLATE says what HNBRDF_INLINE is: functions in headers of src/core,
# which must become part of the kernels to get their instructions.

function fail(message)
{
    print "amalgamate.awk: " message > "/dev/stderr"
    failed = 1
    exit 1
}

# The lines of a file as text[path, 1...lines[path]]; what was read is kept.
function read(path, line, n, status)
{
    if (path in lines)
        return
    while ((status = getline line < path) > 0)
        text[path, ++n] = line
    close(path)
    if (status < 0 || n == 0)
        fail(path ": cannot be read, or is empty")
    lines[path] = n
    guarded[path] = has_guard(path)
}

# 1 where the first directives are #ifndef X and #define X.
function has_guard(path, k, part)
{
    for (k = 1; k < lines[path]; k++)
        if (text[path, k] ~ /^#/) {
            split(text[path, k], part, " ")
            return part[1] == "#ifndef" && text[path, k + 1] ~ ("^#define " part[2] "$")
        }
    return 0
}

# The path of what a line includes by "...", or "". Public headers are in hnbrdf.h: "-".
function included(line, part)
{
    if (line !~ /^[ \t]*#[ \t]*include[ \t]*"/)
        return ""
    split(line, part, "\"")
    return part[2] ~ /^hnbrdf\// ? "-" : root "/src/" part[2]
}

# ---- Names -------------------------------------------------------------------------------------

# Splits a line into token[1...] and kind[]: "name", "other", "space" (comments and literals too).
# Joined again, the tokens are the line. in_comment goes on from line to line.
function split_line(line, n)
{
    n = 0
    while (line != "") {
        if (in_comment) {
            if (match(line, /\*\//)) {
                in_comment = 0
                line = take(line, RSTART + 1, ++n, "space")
            } else
                line = take(line, length(line), ++n, "space")
        } else if (line ~ /^\/\*/) {
            in_comment = 1
            line = take(line, 2, ++n, "space")
        } else if (match(line, /^[ \t]+/))
            line = take(line, RLENGTH, ++n, "space")
        else if (match(line, /^"([^"\\]|\\.)*"/) || match(line, /^'([^'\\]|\\.)*'/))
            line = take(line, RLENGTH, ++n, "space")
        else if (match(line, /^[A-Za-z_][A-Za-z_0-9]*/))
            line = take(line, RLENGTH, ++n, "name")
        else if (match(line, /^\.?[0-9]([A-Za-z_0-9.]|[eEpP][+-])*/) || match(line, /^->/))
            line = take(line, RLENGTH, ++n, "other")
        else
            line = take(line, 1, ++n, "other")
    }
    return n
}
function take(line, length_of, n, of_kind)
{
    token[n] = substr(line, 1, length_of)
    kind[n] = of_kind
    return substr(line, length_of + 1)
}

# unit has the file-scope name.
function note(unit, name)
{
    if (!((unit, name) in has)) {
        has[unit, name] = 1
        units_with[name]++
        if (unit ~ /\.h$/)
            in_header[name] = 1
    }
}

# Notes what a directive defines; 1 where the line after it goes on with it.
function scan_directive(unit, line, part)
{
    if (line ~ /^#[ \t]*define/) {
        split(line, part, /[ \t(]+/)
        if (unit !~ /\.h$/)
            ends[unit] = ends[unit] " " part[2]
        else
            note(unit, part[2])
        if (line ~ /static/)
            means_static[part[2]] = 1
    }
    return line ~ /\\$/
}

# The names that a statement at file scope brings, as far as they stay in their unit. S[1...n] are
# its tokens, those within braces, parentheses and brackets too.
function scan_statement(unit, n, i, depth, is_static, is_typedef, name, last)
{
    for (i = 1; i <= n; i++) {
        is_static = is_static || S[i] == "static" || S[i] in means_static
        is_typedef = is_typedef || S[i] == "typedef"
        if (S[i] ~ /^(struct|union|enum)$/ && S[i + 1] ~ /^[A-Za-z_]/ && S[i + 2] == "{" &&
            !(S[i + 1] in in_header)) # or it is the type that a header declares
            note(unit, S[i + 1])
        if (S[i] == "enum" && (S[i + 1] == "{" || S[i + 2] == "{"))
            scan_enum(unit, n, S[i + 1] == "{" ? i + 1 : i + 2)
    }
    if (!is_static && !is_typedef)
        return
    for (i = 1; i <= n; i++) {
        if (S[i] == "__attribute__")
            i = closing(i + 1, n) + 1
        if (S[i] == "(" && is_typedef && S[i + 1] == "*")
            last = S[i + 2]
        if (S[i] == "{") { # the members of a type, the text of a function, values
            i = closing(i, n)
            continue
        }
        if (S[i] == "(" || S[i] == "[" || S[i] == "=" || S[i] == ";" || S[i] == ",") {
            if (last != "")
                note(unit, last)
            if (S[i] == "(" && !is_typedef)
                return
            if (S[i] == "[")
                i = closing(i, n)
            while (S[i] == "=" && S[++i] != "" && S[i] !~ /^[,;]$/)
                if (S[i] ~ /^[({[]$/)
                    i = closing(i, n)
            last = ""
        } else if (S[i] ~ /^[A-Za-z_]/)
            last = S[i]
    }
}
function scan_enum(unit, n, i, expects)
{
    expects = 1
    for (i++; i <= n && S[i] != "}"; i++) {
        if (expects && S[i] ~ /^[A-Za-z_]/)
            note(unit, S[i])
        expects = S[i] == ","
        if (S[i] == "(")
            i = closing(i, n)
    }
}
# Where what is opened at S[i] is closed.
function closing(i, n, depth)
{
    for (; i <= n; i++) {
        if (S[i] ~ /^[({[]$/)
            depth++
        if (S[i] ~ /^[]})]$/ && --depth == 0)
            return i
    }
    return n
}

# Notes the file-scope names of a file in unit, and of what it includes for the first time.
function scan(path, unit, k, line, other, n, i, count, depth, goes_on)
{
    if (path in scanned && guarded[path])
        return
    scanned[path] = 1
    read(path)
    for (k = 1; k <= lines[path]; k++) {
        line = text[path, k]
        if (goes_on || (!in_comment && line ~ /^[ \t]*#/)) {
            other = goes_on ? "" : included(line)
            goes_on = goes_on ? line ~ /\\$/ : scan_directive(unit, line)
            if (other != "" && other != "-") {
                read(other)
                scan(other, guarded[other] ? other : unit)
            }
            continue
        }
        n = split_line(line)
        for (i = 1; i <= n; i++) {
            if (kind[i] == "space")
                continue
            S[++count] = token[i]
            depth += token[i] ~ /^[({[]$/
            depth -= token[i] ~ /^[]})]$/
            if (depth == 0 && (token[i] == ";" || (token[i] == "}" && is_function(count)))) {
                S[count + 1] = S[count + 2] = ""
                scan_statement(unit, count)
                count = 0
            }
        }
    }
    if (depth != 0)
        fail(path ": braces do not match")
}
# Whether the statement S[1...n], which ends with }, is a function: ") {" at its outermost level.
function is_function(n, i)
{
    for (i = 1; i <= n; i++) {
        if (S[i] == "{")
            return S[i - 1] == ")"
        if (S[i] == "=")
            return 0
        if (S[i] == "(")
            i = closing(i, n)
    }
    return 0
}

# ---- Text --------------------------------------------------------------------------------------

# A line with the names of unit that others have too under their long names. Members (after . and
# ->) keep theirs.
function renamed(line, unit, n, i, out, before)
{
    n = split_line(line)
    for (i = 1; i <= n; i++) {
        if (kind[i] == "name" && before != "." && before != "->" && units_with[token[i]] > 1 &&
            (unit, token[i]) in has)
            out = out prefix[unit] token[i]
        else
            out = out token[i]
        if (kind[i] != "space")
            before = token[i]
    }
    return out
}

# Prints the text of a file as part of unit. Depth counts conditions, the guard left out.
function emit(path, unit, k, line, other, depth, words)
{
    depth = guarded[path] ? -1 : 0
    for (k = 1; k <= lines[path]; k++) {
        line = text[path, k]
        other = in_comment ? "" : included(line)
        if (other != "") {
            if (other != "-" && !guarded[other])
                emit(other, unit)
            continue
        }
        if (!in_comment && line ~ /^[ \t]*#/) {
            split(line, words, /[ \t]+/)
            if (depth == 0 && line ~ /^#include </ && words[2] in system_header)
                continue
            if (line ~ /^#define (_|WIN32_)/) {
                if (!(words[2] in begun))
                    fail(path ": defines " words[2] " for system headers, the beginning does not")
                continue
            }
            depth += line ~ /^[ \t]*#[ \t]*if/
            depth -= line ~ /^[ \t]*#[ \t]*endif/
        }
        if (path ~ /\/core\/[a-z_]+\.h$/ && guarded[path])
            sub(/^static inline /, "HNBRDF_INLINE ", line)
        print renamed(line, unit)
    }
}

# Which system headers are included without a condition, in a file and what it includes.
function find_system_headers(path, k, line, depth, words, other)
{
    if (path in searched)
        return
    searched[path] = 1
    depth = guarded[path] ? -1 : 0
    for (k = 1; k <= lines[path]; k++) {
        line = text[path, k]
        if (line !~ /^[ \t]*#/)
            continue
        split(line, words, /[ \t]+/)
        if (depth == 0 && line ~ /^#include </)
            system_header[words[2]] = 1
        depth += line ~ /^[ \t]*#[ \t]*if/
        depth -= line ~ /^[ \t]*#[ \t]*endif/
        other = included(line)
        if (other != "" && other != "-")
            find_system_headers(other)
    }
}

# Prints the headers that a file includes, and that these include, each once and after its own.
function emit_headers(path, k, other)
{
    if (path in headed)
        return
    headed[path] = 1
    for (k = 1; k <= lines[path]; k++) {
        other = included(text[path, k])
        if (other != "" && other != "-")
            emit_headers(other)
    }
    if (path ~ /\.h$/ && guarded[path]) {
        print "\n/* ==== " substr(path, length(root) + 2) " ==== */"
        emit(path, path)
    }
}

function print_sorted(headers, n, name, sorted, i, j)
{
    for (name in headers) {
        for (i = ++n; i > 1 && sorted[i - 1] > name; i--)
            sorted[i] = sorted[i - 1]
        sorted[i] = name
    }
    for (i = 1; i <= n; i++)
        print "#include " sorted[i]
}

# Prints the template, with its sources and system headers in their places.
function fill(path, k, line)
{
    for (k = 1; k <= lines[path]; k++) {
        line = text[path, k]
        if (line == "SYSTEM_HEADERS")
            print_sorted(system_header)
        else if (line == "SOURCES")
            emit_all()
        else if (!(k in of_kernel))
            print line
    }
}

# What the template has for kernels goes to before[NAME] and after[NAME]; what it defines to begun.
function read_template(path, k, line, name, behind, word)
{
    read(path)
    for (k = 1; k <= lines[path]; k++) {
        line = text[path, k]
        if (line ~ /^# *define/) {
            split(line, word, /^# *define |[ (]/)
            begun[word[2]] = 1
        }
        if (line ~ /^KERNEL /) {
            name = substr(line, 8)
            of_kernel[k] = 1
            behind = 0
        } else if (name != "") {
            of_kernel[k] = 1
            if (line == "KERNEL_TEXT")
                behind = 1
            else if (line == "KERNEL_END")
                name = ""
            else if (behind)
                after[name] = after[name] line "\n"
            else
                before[name] = before[name] line "\n"
        }
    }
}

function emit_all(i, name, k, m, macro)
{
    for (i = 2; i < ARGC; i++)
        emit_headers(path[i])
    for (i = 2; i < ARGC; i++) {
        name = path[i]
        sub(/^.*\//, "", name)
        sub(/\.c$/, "", name)
        in_kernel = sub(/^kernel_/, "", name) && name in before
        print "\n/* ==== " shown(ARGV[i]) " ==== */"
        if (in_kernel)
            printf "%s", before[name]
        emit(path[i], path[i])
        m = split(ends[path[i]], macro, " ")
        for (k = 1; k <= m; k++)
            if (macro[k] !~ /^(_|WIN32_)/)
                print "#undef " macro[k]
        if (in_kernel)
            printf "%s", after[name]
    }
}
function shown(name)
{
    if (name ~ /^\//)
        sub(/^.*\//, "", name)
    return name
}

BEGIN {
    for (i = 1; i < ARGC; i++)
        path[i] = ARGV[i] ~ /^\// ? ARGV[i] : root "/" ARGV[i]
    read_template(path[1])
    for (i = 2; i < ARGC; i++) {
        scan(path[i], path[i])
        find_system_headers(path[i])
        n = split(path[i], part, "/")
        sub(/\.c$/, "_", part[n])
        prefix[path[i]] = part[n - 1] "_" part[n]
    }
    fill(path[1])
    exit 0 # the files are read; awk itself shall not
}
END {
    if (failed)
        exit 1
}
