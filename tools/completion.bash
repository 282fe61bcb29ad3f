# Completes goshawk and tools/goshawk in bash: source tools/completion.bash
#
# Verbs and options come from the program's own --help, components and parameters from what is
# installed, nodes from the domain: none of them is ever out of date.

# Parameters of a component ($2) that `param $3` takes: set only those that change at run time.
_goshawk_parameters() {
  "$1" param describe "${2##*/}" 2>/dev/null | awk -v verb="$3" '
    /^[a-z]/ { name = $1 }
    /takes effect at/ { if (verb != "set" || /run time/) print name }'
}

# The words that a parameter ($3) may be, where it is one of some.
_goshawk_values() {
  "$1" param describe "${2##*/}" "$3" 2>/dev/null | awk '
    /^[a-z].*\(bool/ { print "true false" }
    sub(/^  range: one of /, "") { gsub(/,/, ""); print }'
}

# Behind `goshawk param VERB`; the words before the one at hand are $2 and on.
_goshawk_param() {
  local program=$1 verb=$3
  shift 3
  if [[ $# -eq 0 && $verb == describe ]]; then
    "$program" param list 2>/dev/null
  elif [[ $# -eq 0 ]]; then
    "$program" node list --timeout 1 2>/dev/null
  elif [[ $verb == set && $(($# % 2)) -eq 0 ]]; then
    _goshawk_values "$program" "$1" "${*: -1}"
  elif [[ $verb =~ ^(get|set|describe)$ ]]; then
    _goshawk_parameters "$program" "$1" "$verb"
  fi
}

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
  elif [[ ${before[0]} == run && ${#before[@]} -eq 1 ]]; then
    choices=$("$program" param list 2>/dev/null)
  elif [[ ${before[0]} == conform && ${#before[@]} -eq 1 ]]; then
    choices="path_search corridor_builder trajectory_optimizer tracker map_server"
  elif [[ ${before[0]} == topic && ${before[1]} != list && ${#before[@]} -eq 2 ]]; then
    choices=$("$program" topic list --timeout 1 2>/dev/null)
  elif [[ ${before[0]} == param && ${#before[@]} -ge 2 ]]; then
    choices=$(_goshawk_param "$program" "${before[@]}")
  fi
  mapfile -t COMPREPLY < <(compgen -W "$choices" -- "$word")
}

complete -o default -F _goshawk goshawk tools/goshawk
