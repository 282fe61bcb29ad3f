# Completes goshawk and tools/goshawk in bash: source tools/completion.bash
#
# Verbs and options come from the program's own --help, so that they are never out of date.

_goshawk() {
  local program=${COMP_WORDS[0]} word=${COMP_WORDS[COMP_CWORD]} choices=
  local -a before=("${COMP_WORDS[@]:1:COMP_CWORD-1}")
  COMPREPLY=()
  if [[ $word == -* ]]; then
    local -a verbs=()
    for w in "${before[@]}"; do [[ $w == -* ]] && break || verbs+=("$w"); done
    choices=$("$program" "${verbs[@]:0:2}" --help 2>/dev/null | grep -oE -e '--[a-z][a-z-]*' | sort -u)
  elif [[ ${#before[@]} -eq 0 || ( ${#before[@]} -eq 1 && ${before[0]} =~ ^(bench|topic|node|param)$ ) ]]; then
    choices=$("$program" "${before[@]}" --help 2>/dev/null | sed -nE 's/^  ([a-z]+) .*/\1/p')
  elif [[ ${before[0]} == launch && ${#before[@]} -eq 1 ]]; then
    choices=$("$program" launch --list 2>/dev/null)
  elif [[ ${before[0]} == run && ${#before[@]} -eq 1 || "${before[*]}" == "param describe" ]]; then
    choices=$("$program" param list 2>/dev/null)
  fi
  mapfile -t COMPREPLY < <(compgen -W "$choices" -- "$word")
}

complete -o default -F _goshawk goshawk tools/goshawk
