#ifndef PENUMBRA_TEXELS_GLSL
#define PENUMBRA_TEXELS_GLSL
// Arrays of vec4 for fetching: texels of a buffer (gpu::TexelView) where the shader is compiled with TEXEL_BUFFERS, else
// entries of a TexelArray.
#ifdef TEXEL_BUFFERS
#define Texels samplerBuffer
vec4 texel(Texels array, uint i) { return texelFetch(array, int(i)); }
#else
#define Texels sampler2D
vec4 texel(Texels array, uint i) { return texelFetch(array, ivec2(i & 8191u, i >> 13u), 0); }
#endif
#endif
