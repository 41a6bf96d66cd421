# Clang and its tools: version 14 of Debian 12 or 19 of Debian 13, as script/bootstrap installs them, else the system's.
find_program(LOBE_CLANG NAMES clang-14 clang-19 clang)
find_program(LOBE_CLANG_TIDY NAMES clang-tidy-14 clang-tidy-19 clang-tidy)
# Other versions lay code out differently.
find_program(LOBE_CLANG_FORMAT NAMES clang-format-14)
