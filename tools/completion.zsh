# Completes goshawk and tools/goshawk in zsh, after compinit: source tools/completion.zsh
#
# The program itself is asked what may follow: its one parser knows, so this is never out of date.

_goshawk() {
  local -a choices
  choices=("${(@f)$("${words[1]}" complete "${(@)words[2,CURRENT]}" 2>/dev/null)}")
  choices=(${choices:#})
  if (( ${#choices} )); then
    compadd -a choices
  else
    _files
  fi
}

compdef _goshawk goshawk tools/goshawk
