_credence_reply() {
    local reply
    while IFS= read -r reply; do
        if [[ $COMP_WORDBREAKS != *=* ]]; then reply=${current%"$value"}$reply
        elif [[ $value == *=* ]]; then reply=${reply#"${value%=*}="}
        fi
        COMPREPLY+=("$reply")
    done
}

_credence_words() { _credence_reply < <(compgen -W "$*" -- "$value"); }

# Words behind `section.key=`.
_credence_words_after() {
    local words=() word
    for word in $1; do words+=("${value%%=*}=$word"); done
    _credence_words "${words[@]}"
}

# Folders, and files of these extensions; `h5.journal` stands for the file that the journal is of.
_credence_files() {
    local extension
    compopt -o filenames 2>/dev/null
    if [[ $1 == '*' ]]; then _credence_reply < <(compgen -f -- "$value"); return; fi
    _credence_reply < <(compgen -d -- "$value")
    for extension; do
        if [[ $extension == *.journal ]]; then
            _credence_reply < <(compgen -f -X "!*.$extension" -- "$value" |
                while IFS= read -r extension; do printf '%s\n' "${extension%.journal}"; done)
        else
            _credence_reply < <(compgen -f -X "!*.$extension" -- "$value")
        fi
    done
}

@KEYS@_credence() {
    local words=() word i glued= current option= value= command= options= again=
    COMPREPLY=()
    for ((i = 1; i <= COMP_CWORD; ++i)); do
        word=${COMP_WORDS[i]}
        if [[ $word == = && ${#words[@]} -gt 0 ]]; then
            words[-1]+='='; glued=1
        elif [[ $glued ]]; then
            words[-1]+=$word; glued=
        else
            words+=("$word")
        fi
    done
    current=${words[-1]-} value=$current
    if ((${#words[@]} > 1)); then command=${words[0]} option=${words[-2]}; fi
    if [[ $current == --*=* ]]; then option=${current%%=*} value=${current#*=}; fi
    case $command in
        '') options='@NAMES@' ;;
@COMMANDS@    esac
    # Options that are not there yet, or may be given again.
    local left=()
    for word in $options; do
        [[ " ${words[*]:0:${#words[@]}-1} " == *" $word "* && " $again " != *" $word "* ]] || left+=("$word")
    done
    _credence_words "${left[@]}"
}

complete -F _credence @PROGRAM@
