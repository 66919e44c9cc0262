# doxygen_filter.awk: a public header as Doxygen reads it; its INPUT_FILTER. The comments of the headers
# are plain: here those before a declaration, and those behind a member, become Doxygen's. A heading
# (a comment that begins with four hyphens) becomes a group. A function that follows another without a
# blank line shares its comment; members of one declaration share theirs.

# What Doxygen would take for a command, a link or HTML.
function escaped(text) {
    gsub(/[\\@<>&#%$]/, "\\\\&", text)
    return text
}

# Reads a comment that begins in `text`, at line i, into its lines: comment[1..size]; i moves on.
function read_comment(text,   line) {
    size = 0
    sub(/^\/\* ?/, "", text)
    while (text !~ /\*\//) {
        comment[++size] = text
        text = lines[++i]
        if (text ~ /^ *\*\//) # its end, in a line of its own
            return
        if (!sub(/^ *\* ?/, "", text)) # goes on behind a member
            sub(/^ */, "", text)
    }
    sub(/ *\*\/.*/, "", text)
    if (text != "")
        comment[++size] = text
}

# The lines from..size as Doxygen's text; what is indented, a table or a formula, stays as it is.
function body(from,   k, out, shown) {
    for (k = from; k <= size; k++) {
        if (shown && comment[k] !~ /^  / && comment[k] != "") {
            out = out "\n@endverbatim"
            shown = 0
        }
        if (!shown && comment[k] ~ /^  / && tables) {
            out = out "\n@verbatim"
            shown = 1
        }
        out = out (k > from ? "\n" : "") (shown ? comment[k] : escaped(comment[k]))
    }
    return out (shown ? "\n@endverbatim" : "")
}
# One declaration of several members, each with the comment.
function members(code, doc,   type, names, count, k, out) {
    if (code !~ /^ +(const )?[a-z_0-9]+ [^()]*,[^()]*;$/ || !inside)
        return code " /**< " doc " */"
    match(code, /^ +(const )?[a-z_0-9]+ /)
    type = substr(code, 1, RLENGTH)
    code = substr(code, RLENGTH + 1)
    sub(/;$/, "", code)
    count = split(code, names, /, */)
    for (k = 1; k <= count; k++)
        out = out type names[k] "; /**< " doc " */" (k < count ? "\n" : "")
    return out
}

{ lines[NR] = $0 }

END {
    for (i = 1; i <= NR; i++) {
        line = lines[i]
        if (line ~ /^ *\/\*/) {
            text = line
            sub(/^ */, "", text)
            read_comment(text)
            tables = !inside
            if (!started) {
                started = 1
                sub(/:.*/, "", comment[1])
                name = comment[1]
                split(lines[1], title, /^[^:]*: */)
                comment[1] = title[2]
                print "/** @file " name "\n" body(1) " */"
                if (name == "hnbrdf.h")
                    print "/** @mainpage The C interface\n" body(1) " */"
            } else if (comment[1] ~ /^----/) {
                if (group)
                    print "/** @} */"
                gsub(/^-+ | -+$/, "", comment[1])
                group++
                id = name
                gsub(/[^a-z0-9]/, "_", id)
                print "/** @defgroup " id "_" group " " escaped(comment[1]) "\n" body(2) "\n@{ */"
            } else {
                doc = body(1)
                if (lines[i + 1] ~ /^HNBRDF_EXPERIMENTAL/)
                    doc = doc "\n\nExperimental: may change in a minor version."
                wanted = 1
                print "/** " doc " */"
            }
            continue
        }
        if (line == "")
            doc = ""
        if (line ~ /^}/)
            inside = ""
        if (line ~ /^#ifdef __cplusplus/ && group && lines[i + 1] ~ /^}/) {
            print "/** @} */"
            group = 0
        }
        at = match(line, /[^ ].*[^ ] +\/\*/) ? RSTART + RLENGTH - 2 : 0
        if (at) {
            code = substr(line, 1, at - 1)
            sub(/ +$/, "", code)
            read_comment(substr(line, at))
            tables = 0
            print members(code, body(1))
        } else if (line ~ /^(HNBRDF_|#define)/ && doc != "" && !wanted) {
            print "/** " doc " */"
            print line
        } else {
            if (inside && wanted && line ~ /^ +[a-z_0-9 ]+ [^()]*,[^()]*;$/)
                print members(line, doc)
            else if (inside == "struct" && !wanted && line ~ /^ +(const )?hnbrdf_[a-z_0-9]+ .*;$/) {
                match(line, /hnbrdf_[a-z_0-9]+/) # its type says what it is
                print line " /**< See " substr(line, RSTART, RLENGTH) ". */"
            } else if (inside == "struct" && !wanted && line ~ /^ +void \*([a-z]+_)?user;$/)
                print line " /**< Passed on to the function. */"
            else if (inside == "struct" && !wanted && line ~ /^ +(int|size_t) [a-z]+_count;$/)
                print line " /**< How many. */"
            else
                print line
            if (inside && line ~ /[;,]$/)
                wanted = 0
        }
        if (line ~ /\{$/ && line ~ /(struct|enum)/) {
            inside = line ~ /struct/ ? "struct" : "enum"
            doc = ""
        }
        if (line ~ /^(HNBRDF_|typedef|#define)/)
            wanted = 0
    }
}
