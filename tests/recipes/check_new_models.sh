#!/bin/sh
# Fails unless every suite of the catalogue has cases of the models that script/new-model made, recipe_<pattern>, and these
# pass.
# usage: check_new_models.sh PROGRAM MODEL...
set -u
program=$1
shift
listed=$("$program" --gtest_list_tests) || exit 1
for model in "$@"; do
  for suite in "^$model/ModelKernel" "^  IsFoundByItsName/$model " "^  IsReciprocal[A-Za-z]*/${model}_" "^  IsNoNaN[A-Za-z]*/${model}_" \
    "^  IsWhatTheCatalogueSays/${model}_"; do
    printf '%s\n' "$listed" | grep -q "$suite" || { echo "check_new_models: nothing is listed as '$suite'"; exit 1; }
  done
done
exec "$program" --gtest_brief=1 '--gtest_filter=*recipe_*:KnownValues.*:ModelTests.*:EnergyExcess.*'
