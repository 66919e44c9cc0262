# help_manual.awk: a manual page (man(7)) from what --help prints; run by help.sh.
# name: of the page; about: one line; see: names of other pages, all in section 1.

# What troff would take for something else.
function escaped(text) {
    gsub(/\\/, "\\e", text)
    gsub(/-/, "\\-", text)
    gsub(/\^/, "\\(ha", text)
    gsub(/~/, "\\(ti", text)
    gsub(/'/, "\\(aq", text)
    while (match(text, /`[^`]*`/)) # `code` is bold
        text = substr(text, 1, RSTART - 1) "\\fB" substr(text, RSTART + 1, RLENGTH - 2) "\\fR" \
            substr(text, RSTART + RLENGTH)
    gsub(/`/, "\\(ga", text)
    if (text ~ /^\./)
        text = "\\&" text
    return text
}
function say(text) { wrap(escaped(text)) }
# Running text, in lines of at most 78 columns.
function wrap(text,   words, count, k, line) {
    count = split(text, words, " ")
    for (k = 1; k <= count; k++) {
        if (line != "" && length(line) + 1 + length(words[k]) > 78) {
            put(line)
            line = ""
        }
        line = line == "" ? (words[k] ~ /^\./ ? "\\&" : "") words[k] : line " " words[k]
    }
    if (line != "")
        put(line)
}
# Paragraphs begin where there is text before them and after.
function put(line) {
    if (fresh == 2 && line !~ /^\.(TP|SH)/)
        print ".PP"
    print line
    fresh = 0
}
function paragraph() { if (!fresh) fresh = 2 }
function section(title) {
    print ".SH " title
    fresh = 1
}
function verbatim(on) {
    if (on && !shown) {
        paragraph()
        put(".in +2n\n.nf")
    }
    if (!on && shown) {
        put(".fi\n.in")
        paragraph()
    }
    shown = on
}
# A tag and what stands in the column beside it.
function item(tag, text) {
    verbatim(0)
    put(".TP\n" tag)
    say(text)
}
function indent(line) { match(line, /^ */); return RLENGTH }
# The column where the text beside a tag begins, 0 if there is none: two blanks or more before it, or
# a colon ("Out: what").
function column(line,   from) {
    if (match(line, /^[A-Z][a-z]*: +/))
        return RLENGTH
    from = indent(line)
    if (match(substr(line, from + 1), /[^ ]  +[^ ]/))
        return from + RSTART + RLENGTH - 2
    return 0
}

{ lines[NR] = $0 }

END {
    printf ".TH %s 1 \"%s\" \"hnbrdf %s\" \"User Commands\"\n", toupper(name), date, version
    section("NAME")
    wrap(name " \\- " escaped(about))
    section("SYNOPSIS")
    put(".nf")
    for (i = 1; i <= NR && lines[i] != ""; i++)
        put(escaped(substr(lines[i], 8))) # behind "usage: "
    put(".fi")
    section("DESCRIPTION")
    for (i = described(i + 1); i <= NR; i++)
        if (lines[i] == "options:") {
            section("OPTIONS")
            i = listed(i + 1, 1)
        } else if (lines[i] == "commands:") {
            section("COMMANDS")
            i = listed(i + 1, 0)
            paragraph()
            i = described(i + 1) - 1
        } else if (lines[i] == "examples:") {
            section("EXAMPLES")
            put(".nf")
            for (i++; i <= NR && lines[i] != ""; i++)
                put(escaped(substr(lines[i], 3)))
            put(".fi")
        }
    section("EXIT STATUS")
    say("0: done. 1: it failed, or was interrupted; one line says why. 2: the command line is wrong, and nothing was done.")
    section("SEE ALSO")
    count = split(see, pages, /[ \n]+/)
    for (k = 1; k <= count; k++)
        put(".BR " escaped(pages[k]) " (1)" (k < count ? "," : ""))
}

# Paragraphs, until one of the lists. Returns the line that ended them.
function described(i,   line, next_line, at, beside) {
    for (; i <= NR && lines[i] !~ /^(options|commands|examples):$/; i++) {
        line = lines[i]
        next_line = i < NR ? lines[i + 1] : ""
        at = column(line)
        if (line == "") {
            verbatim(0)
            paragraph()
            beside = 0
        } else if (beside && indent(line) == beside) { # goes on beside its tag
            say(line)
        } else if (at && !shown && (indent(next_line) == at || (indent(line) >= 2 && !is_verbatim(next_line)))) {
            item(escaped(trimmed(substr(line, 1, at))), substr(line, at + 1))
            beside = at
        } else if (indent(line) >= 2) {
            verbatim(1)
            put(escaped(substr(line, 3)))
            beside = 0
        } else {
            verbatim(0)
            if (beside)
                paragraph()
            beside = 0
            say(line)
        }
    }
    verbatim(0)
    return i
}
function is_verbatim(line) { return indent(line) >= 2 && !column(line) }
function trimmed(text) { sub(/^ +/, "", text); sub(/ +$/, "", text); return text }

# Options, or commands: a tag, then text in a column. Returns the line behind.
function listed(i, are_options,   line, at, tag, words, count, k, text) {
    for (; i <= NR && lines[i] != ""; i++) {
        line = lines[i]
        if (indent(line) > 6) { # goes on
            say(line)
            continue
        }
        at = column(line)
        tag = trimmed(at ? substr(line, 1, at) : line)
        count = split(tag, words, " ")
        text = ""
        for (k = 1; k <= count; k++)
            text = text (k > 1 ? " " : "") \
                (are_options && words[k] !~ /^-/ ? "\\fI" : "\\fB") escaped(words[k]) "\\fR"
        item(text, at ? substr(line, at + 1) : "")
    }
    return i
}
