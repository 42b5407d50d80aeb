#ifndef PENUMBRA_TEXELS_GLSL
#define PENUMBRA_TEXELS_GLSL
// Entries of a TexelArray.
vec4 texel(sampler2D array, uint i) { return texelFetch(array, ivec2(i & 8191u, i >> 13u), 0); }
#endif
