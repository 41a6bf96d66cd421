# The command in an image: packages are built in one Debian and installed into another.
#   docker build -t lobe .
#   docker run --rm -v "$PWD:/work" lobe distance ward:m=0.2 phong:n=20
FROM debian:13-slim AS build
WORKDIR /lobe
COPY . .
RUN script/bootstrap run && apt-get install --yes --no-install-recommends dpkg-dev file
RUN cmake --preset release -D LOBE_BUILD_TESTS=OFF -D LOBE_BUILD_BENCH=OFF -D CMAKE_INSTALL_PREFIX=/usr && \
    cmake --build --preset release && cd build && cpack -D CPACK_COMPONENTS_ALL=command

FROM debian:13-slim
COPY --from=build /lobe/build/lobe_*.deb /tmp/
RUN apt-get update && apt-get install --yes /tmp/lobe_*.deb && rm -rf /tmp/lobe_*.deb /var/lib/apt/lists/*
# Kernels are compiled on first use and kept for later runs of the same container.
ENV POCL_CACHE_DIR=/var/cache/lobe
RUN mkdir -m 1777 /var/cache/lobe
WORKDIR /work
ENTRYPOINT ["lobe"]
