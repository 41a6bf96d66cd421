#!/bin/sh
# For Doxygen: a header whose declarations are in the group of its room. The rooms are those of lib/src.
# usage: room.sh FILE
case $(basename "$1" .hpp) in
  directions | error | estimate | form | lobe | progress | tolerance | version | work) room=core ;;
  device | self_test) room=device ;;
  grid) room=hemisphere ;;
  colour | evaluate | material | model | profile | proposal | specification) room=model ;;
  brdf_function | cell_error | least_value | reflectance | table) room=table ;;
  algebra | function_composition | inverse | pointwise | spectrum | square_root) room=algebra ;;
  energy | plausibility | prepare | preview | repair | sampling) room=energy ;;
  approximation | clustering | comparison | embedding | fit | judgement | lighting | metric | rank_correlation | \
    table_lighting | table_metric) room=metric ;;
  chosen_file | direction_pairs | foreign_export | measured | measurement | material_file | plausibility_page | preview_sheet | sampling_page | table_file | \
    approximation_pictures | fit_pictures | table_pictures) room=io ;;
  chart | checkpoint | load_reflectance | material_curves | published | report_page | study | study_plan | \
    study_results | study_schema | verify) room=study ;;
  library.dox) cat "$1" && exit ;;
  *) echo "docs/site/room.sh: $1 is in no room" >&2 && exit 1 ;;
esac
# In place of the empty line behind the brace, so that lines keep their numbers.
sed -e "/^namespace lobe {\$/{N;s|{\n|{ /** @addtogroup $room\n@{ */|}" -e "s|^}  // namespace lobe\$|/** @} */ }|" "$1"
