#include "render/glsl_words.hpp"

#include <string>

namespace lobe {
namespace {

constexpr std::string_view kGlslWords =
    " EmitVertex EndPrimitive abs acos acosh active all any asin asinh asm atan atanh atomic_uint attribute bool "
    "break buffer bvec2 bvec3 bvec4 case cast ceil centroid clamp class coherent common const continue cos cosh "
    "cross dFdx dFdy default degrees determinant discard distance do dot double dvec2 dvec3 dvec4 else enum equal "
    "exp exp2 extern external faceforward false filter fixed flat float floatBitsToInt floatBitsToUint floor fma "
    "for fract frexp ftransform fvec2 fvec3 fvec4 fwidth goto greaterThan greaterThanEqual half highp hvec2 hvec3 "
    "hvec4 if iimage1D iimage1DArray iimage2D iimage2DArray iimage3D iimageBuffer iimageCube image1D image1DArray "
    "image1DArrayShadow image1DShadow image2D image2DArray image2DArrayShadow image2DShadow image3D imageBuffer "
    "imageCube in inline inout input int intBitsToFloat interface invariant inverse inversesqrt isampler1D "
    "isampler1DArray isampler2D isampler2DArray isampler2DMS isampler2DMSArray isampler2DRect isampler3D "
    "isamplerBuffer isamplerCube isinf isnan ivec2 ivec3 ivec4 layout ldexp length lessThan lessThanEqual log log2 "
    "long lowp main mat2 mat2x2 mat2x3 mat2x4 mat3 mat3x2 mat3x3 mat3x4 mat4 mat4x2 mat4x3 mat4x4 matrixCompMult "
    "max mediump min mix mod modf namespace noinline noise1 noise2 noise3 noise4 noperspective normalize not "
    "notEqual out outerProduct output packHalf2x16 packSnorm2x16 packUnorm2x16 packed partition patch pow precise "
    "precision public radians readonly reflect refract resource restrict return round roundEven row_major sample "
    "sampler1D sampler1DArray sampler1DArrayShadow sampler1DShadow sampler2D sampler2DArray sampler2DArrayShadow "
    "sampler2DMS sampler2DMSArray sampler2DRect sampler2DRectShadow sampler2DShadow sampler3D sampler3DRect "
    "samplerBuffer samplerCube samplerCubeShadow shadow1D shadow1DLod shadow1DProj shadow1DProjLod shadow2D "
    "shadow2DLod shadow2DProj shadow2DProjLod shared short sign sin sinh sizeof smooth smoothstep sqrt static step "
    "struct subroutine superp switch tan tanh template texelFetch texelFetchOffset texture texture1D texture1DLod "
    "texture1DProj texture1DProjLod texture2D texture2DLod texture2DProj texture2DProjLod texture3D texture3DLod "
    "texture3DProj texture3DProjLod textureCube textureCubeLod textureGrad textureGradOffset textureLod "
    "textureLodOffset textureOffset textureProj textureProjGrad textureProjGradOffset textureProjLod "
    "textureProjLodOffset textureProjOffset textureSize this transpose true trunc typedef uimage1D uimage1DArray "
    "uimage2D uimage2DArray uimage3D uimageBuffer uimageCube uint uintBitsToFloat uniform union unpackHalf2x16 "
    "unpackSnorm2x16 unpackUnorm2x16 unsigned usampler1D usampler1DArray usampler2D usampler2DArray usampler2DMS "
    "usampler2DMSArray usampler2DRect usampler3D usamplerBuffer usamplerCube using uvec2 uvec3 uvec4 varying vec2 "
    "vec3 vec4 void volatile while writeonly ";

}  // namespace

bool is_glsl_word(std::string_view word) {
  const std::string whole = " " + std::string(word) + " ";
  return word.starts_with("gl_") || word.find("__") != std::string_view::npos ||
         kGlslWords.find(whole) != std::string_view::npos;
}

}  // namespace lobe
