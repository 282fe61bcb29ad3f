# Completes goshawk and tools/goshawk in fish: source tools/completion.fish
#
# The program itself is asked what may follow: its one parser knows, so this is never out of date.

function __goshawk_complete
    set -l words (commandline -opc)
    set -l current (commandline -ct)
    set -l choices ($words[1] complete $words[2..-1] "$current" 2>/dev/null)
    if set -q choices[1]
        printf '%s\n' $choices
    else
        __fish_complete_path "$current"
    end
end

complete -c goshawk -f -a '(__goshawk_complete)'
