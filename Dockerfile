# A container with the program and the built-in example:
#
#   docker build -t tapa-mvs .
#   docker run --rm tapa-mvs                                        # the demo
#   docker run --rm -v "$PWD:/data" tapa-mvs scripts/demo.sh /data/PHOTOS
#   docker run --rm tapa-mvs colmap help
FROM debian:12 AS build
WORKDIR /opt/tapa-mvs
COPY scripts scripts
RUN scripts/install_deps.sh
COPY . .
RUN scripts/package.sh

FROM debian:12-slim
WORKDIR /opt/tapa-mvs
COPY scripts scripts
COPY evaluation evaluation
COPY examples/room examples/room
COPY --from=build /opt/tapa-mvs/build/*.deb packages/
RUN scripts/install_deps.sh evaluation && \
    apt-get install -y --no-install-recommends ./packages/*.deb && \
    rm -rf packages /var/lib/apt/lists/*
ENV TAPA_BIN_DIR=/usr/bin
CMD ["scripts/demo.sh"]
