// What every shader may use. Include after #version and #extension GL_GOOGLE_include_directive; compute shaders define PENUMBRA_COMPUTE before it.
#ifndef PENUMBRA_COMMON_GLSL
#define PENUMBRA_COMMON_GLSL
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require

layout(buffer_reference, std430, buffer_reference_align = 4) buffer UintArray { uint at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) buffer IntArray { int at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) buffer FloatArray { float at[]; };
layout(buffer_reference, std430, buffer_reference_align = 8) buffer Vec2Array { vec2 at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer Vec4Array { vec4 at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer UVec4Array { uvec4 at[]; };
// Tightly packed triples (GeometryOnDevice::positions, normals).
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Vec3Array { vec3 at[]; };

#ifdef PENUMBRA_COMPUTE
// Commands::dispatch spills group counts over 65,535 (the guaranteed limit) from x into y: shaders take the linear
// index and return when it is past their count.
uint linear_group() { return gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x; }
// A macro: in a function, gl_WorkGroupSize would be 1 where this file is included before local_size_x is declared.
#define linear_invocation() (linear_group() * gl_WorkGroupSize.x + gl_LocalInvocationID.x)
#endif

#endif
