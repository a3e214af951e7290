// Table of the OpenGL functions that the rasteriser calls, loaded for one context. Private to sim/render.
#pragma once

#include <GL/glcorearb.h>

#include <string>
#include <vector>

namespace sim {

// name in OpenGL without "gl", type of the pointer's part in glcorearb.h (PFNGL...PROC).
#define VOBENCH_GL_FUNCTIONS(X)                                 \
  X(AttachShader, ATTACHSHADER)                                 \
  X(BindFramebuffer, BINDFRAMEBUFFER)                           \
  X(BindTextureUnit, BINDTEXTUREUNIT)                           \
  X(BindVertexArray, BINDVERTEXARRAY)                           \
  X(BlendFunc, BLENDFUNC)                                       \
  X(CheckNamedFramebufferStatus, CHECKNAMEDFRAMEBUFFERSTATUS)   \
  X(ClearNamedFramebufferfv, CLEARNAMEDFRAMEBUFFERFV)           \
  X(ClearNamedFramebufferiv, CLEARNAMEDFRAMEBUFFERIV)           \
  X(ClipControl, CLIPCONTROL)                                   \
  X(CompileShader, COMPILESHADER)                               \
  X(CreateBuffers, CREATEBUFFERS)                               \
  X(CreateFramebuffers, CREATEFRAMEBUFFERS)                     \
  X(CreateProgram, CREATEPROGRAM)                               \
  X(CreateShader, CREATESHADER)                                 \
  X(CreateTextures, CREATETEXTURES)                             \
  X(CreateVertexArrays, CREATEVERTEXARRAYS)                     \
  X(DeleteBuffers, DELETEBUFFERS)                               \
  X(DeleteFramebuffers, DELETEFRAMEBUFFERS)                     \
  X(DeleteProgram, DELETEPROGRAM)                               \
  X(DeleteShader, DELETESHADER)                                 \
  X(DeleteTextures, DELETETEXTURES)                             \
  X(DeleteVertexArrays, DELETEVERTEXARRAYS)                     \
  X(DepthFunc, DEPTHFUNC)                                       \
  X(Disable, DISABLE)                                           \
  X(DrawArrays, DRAWARRAYS)                                     \
  X(DrawElements, DRAWELEMENTS)                                 \
  X(Enable, ENABLE)                                             \
  X(EnableVertexArrayAttrib, ENABLEVERTEXARRAYATTRIB)           \
  X(GetError, GETERROR)                                         \
  X(GetIntegerv, GETINTEGERV)                                   \
  X(GetProgramInfoLog, GETPROGRAMINFOLOG)                       \
  X(GetProgramiv, GETPROGRAMIV)                                 \
  X(GetShaderInfoLog, GETSHADERINFOLOG)                         \
  X(GetShaderiv, GETSHADERIV)                                   \
  X(GetUniformLocation, GETUNIFORMLOCATION)                     \
  X(LinkProgram, LINKPROGRAM)                                   \
  X(NamedBufferStorage, NAMEDBUFFERSTORAGE)                     \
  X(NamedBufferSubData, NAMEDBUFFERSUBDATA)                     \
  X(NamedFramebufferDrawBuffer, NAMEDFRAMEBUFFERDRAWBUFFER)     \
  X(NamedFramebufferReadBuffer, NAMEDFRAMEBUFFERREADBUFFER)     \
  X(NamedFramebufferTexture, NAMEDFRAMEBUFFERTEXTURE)           \
  X(NamedFramebufferTextureLayer, NAMEDFRAMEBUFFERTEXTURELAYER) \
  X(PixelStorei, PIXELSTOREI)                                   \
  X(ReadPixels, READPIXELS)                                     \
  X(Scissor, SCISSOR)                                           \
  X(ShaderSource, SHADERSOURCE)                                 \
  X(TextureBuffer, TEXTUREBUFFER)                               \
  X(TextureParameteri, TEXTUREPARAMETERI)                       \
  X(TextureStorage2D, TEXTURESTORAGE2D)                         \
  X(TextureStorage3D, TEXTURESTORAGE3D)                         \
  X(TextureSubImage2D, TEXTURESUBIMAGE2D)                       \
  X(Uniform1f, UNIFORM1F)                                       \
  X(Uniform1i, UNIFORM1I)                                       \
  X(Uniform2f, UNIFORM2F)                                       \
  X(Uniform2i, UNIFORM2I)                                       \
  X(Uniform3f, UNIFORM3F)                                       \
  X(UniformMatrix3fv, UNIFORMMATRIX3FV)                         \
  X(UniformMatrix4fv, UNIFORMMATRIX4FV)                         \
  X(UseProgram, USEPROGRAM)                                     \
  X(VertexArrayAttribBinding, VERTEXARRAYATTRIBBINDING)         \
  X(VertexArrayAttribFormat, VERTEXARRAYATTRIBFORMAT)           \
  X(VertexArrayElementBuffer, VERTEXARRAYELEMENTBUFFER)         \
  X(VertexArrayVertexBuffer, VERTEXARRAYVERTEXBUFFER)           \
  X(Viewport, VIEWPORT)

struct GlApi {
#define VOBENCH_GL_MEMBER(name, type) PFNGL##type##PROC name = nullptr;
  VOBENCH_GL_FUNCTIONS(VOBENCH_GL_MEMBER)
#undef VOBENCH_GL_MEMBER

  // Fills the table; returns the names of what is not there. `find`: (const char* name) -> pointer to the function.
  template <class Find>
  std::vector<std::string> Load(const Find& find) {
    std::vector<std::string> missing;
#define VOBENCH_GL_LOAD(name, type)                               \
  (name) = reinterpret_cast<PFNGL##type##PROC>(find("gl" #name)); \
  if ((name) == nullptr) missing.emplace_back("gl" #name);
    VOBENCH_GL_FUNCTIONS(VOBENCH_GL_LOAD)
#undef VOBENCH_GL_LOAD
    return missing;
  }
};

#undef VOBENCH_GL_FUNCTIONS

}  // namespace sim
