# Completion of lobe in fish. What may follow, the command itself knows: lobe __complete WORD...

function __lobe_complete
    set -l words (commandline -opc)
    set -l current (commandline -ct)
    set -l answer (command $words[1] __complete $words[2..-1] "$current" 2>/dev/null)
    set -l first (string split \t -- $answer[1])
    test (count $answer) -gt 1; and printf '%s\n' $answer[2..-1]
    switch "$first[1]"
        case files
            __fish_complete_suffix "$first[2]"
        case directories
            __fish_complete_directories "$current" ''
    end
end

complete -c lobe -f -a '(__lobe_complete)'
