# help_completion.awk: lines `table CASE` and `value CASE` for help.sh from what --help prints.
# name: of the command; words: a file of lines "OPTION WORD WORD...".

# What a value or a place of this description takes: words, files ENDING..., data, folder or any.
function kind(argument, option,   parts, count, k, found) {
    if (option in offered)
        return "words" offered[option]
    if (argument ~ /^DIR/)
        return "folder"
    if (argument ~ /^(DATA|SOURCE|MODEL\|DATA)/)
        return argument ~ /^DATA/ ? "data" : "data .safetensors"
    if (argument ~ /^(MODEL2?|OUT)(\.\.\.)?$/ || argument ~ /\.safetensors$/ || option == "--model")
        return "files .safetensors"
    if (argument ~ /^FILE\.[a-z0-9]+(\.\.\.)?$/) {
        sub(/\.\.\.$/, "", argument)
        sub(/^FILE/, "", argument)
        return "files " argument (argument == ".exr" ? " .png" : "")
    }
    if (argument == "FILE")
        return option ~ /^--(csv|json)$/ ? "files ." substr(option, 3) : option == "--plot" ? "files .svg" : "any"
    count = split(argument, parts, "|")
    for (k = 1; k <= count; k++)
        if (parts[k] ~ /^[a-z]/)
            found = found " " parts[k]
    if (argument ~ /\|FILE$/) # an environment
        return "words" found " files .exr .hdr"
    return found != "" && count > 1 ? "words" found : "nothing"
}

BEGIN {
    while ((getline line < words) > 0) {
        at = index(line, " ")
        offered[substr(line, 1, at - 1)] = substr(line, at)
    }
}

/^usage: / { in_usage = 1 }
in_usage && $0 == "" { in_usage = 0 }
in_usage { usage = usage " " $0 }
/^[a-z]/ { in_options = /^options:/ }
in_options && /^  (-., |    )--/ {
    short = /^  -/ ? $1 : ""
    long = $(short == "" ? 1 : 2)
    argument = $(short == "" ? 2 : 3)
    sub(/,$/, "", short)
    options = options " " long
    rest = substr($0, index($0, long) + length(long))
    if (rest !~ /^ [^ ]/)
        next # takes no value
    all[++count] = long
    arguments[long] = argument
    if (short != "")
        shorts[long] = short
}

END {
    sub(/^ *usage: hnbrdf /, "", usage)
    usage = substr(usage, length(name) + 2)
    # -o X.ending of the usage tells what the option's own argument, a mere FILE, does not.
    if (match(usage, /-o +[A-Z]+[.a-z]*/)) {
        ending = substr(usage, RSTART, RLENGTH)
        sub(/^-o +/, "", ending)
        if (ending != "FILE" && arguments["--output"] != "")
            arguments["--output"] = ending
    }
    for (k = 1; k <= count; k++)
        printf "value     \"%s %s\"%s) kind=\"%s\" ;;\n", name, all[k],
            shorts[all[k]] == "" ? "" : " | \"" name " " shorts[all[k]] "\"", kind(arguments[all[k]], all[k])
    # Places: words in capitals that follow no option.
    gsub(/\([^)]*\)/, "", usage)
    gsub(/\[(-|options)[^]]*\]/, "", usage)
    gsub(/[][]/, "", usage)
    fields = split(usage, field, / +/)
    for (k = 1; k <= fields; k++) {
        if (field[k] ~ /^-/) {
            k++
            continue
        }
        if (field[k] !~ /^[A-Z]/)
            continue
        places = places (places == "" ? "" : ",") kind(field[k], "")
    }
    printf "table     \"%s\") options=\"%s\" places=\"%s\" ;;\n", name, substr(options, 2), places
}
